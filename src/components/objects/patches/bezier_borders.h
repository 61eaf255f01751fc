#pragma once
// Finds shared borders of patches and whether the patches enclose a volume.

#include "bezier_patch.h"

namespace etendue::bezier {

/// Whether the patches form a closed orientable surface: every border of every patch coincides with exactly one other border,
/// of another patch or of the same one, or is degenerate (a point), and the patches can be oriented consistently. If so, sets
/// `flipped` of the patches so that all face outwards.
bool close(std::vector<Patch>&);

}  // namespace etendue::bezier
