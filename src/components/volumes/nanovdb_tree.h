#pragma once
// The tree of values of a grid of NanoVDB.

#include <vector>

#include "volume_grid.h"

namespace etendue {

/// Its values over the box of the active ones, from a grid's bytes in memory. No offset in them is believed. Throws Error with
/// the reason alone.
VolumeGrid dense_grid(const std::vector<unsigned char>& bytes);

}  // namespace etendue
