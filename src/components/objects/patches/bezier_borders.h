#pragma once
// Which patches share borders, and whether together they enclose a volume.

#include "bezier_patch.h"

namespace etendue::bezier {

/// Whether every border of every patch is that of exactly one other one (or of the same one, elsewhere), or shrinks to a
/// point, and the patches can be turned so that neighbours face alike. Then turns them to face outwards, by `flipped`.
bool close(std::vector<Patch>&);

}  // namespace etendue::bezier
