#pragma once
// Conversion of the tree of a NanoVDB grid to a dense grid.

#include <vector>

#include "volume_grid.h"

namespace etendue {

/// The values of a grid, given by its bytes in memory, over the box of its active values. All offsets in the bytes are checked.
/// Throws Error whose message is the reason alone.
VolumeGrid dense_grid(const std::vector<unsigned char>& bytes);

}  // namespace etendue
