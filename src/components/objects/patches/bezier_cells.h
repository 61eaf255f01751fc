#pragma once
// Cuts Bézier patches into cells that are nearly flat and nearly parallelograms, on which Newton's method converges.

#include <cstdint>

#include "bezier_patch.h"
#include "etendue/core/vector.h"

namespace etendue::bezier {

/// The part of a patch where |s - s_middle| <= s_half, and likewise for t. Cell coordinates x and y go from -1 to 1.
struct Cell {
  Vector middle, dx, dy;  ///< position and derivatives in the middle
  /// Upper bound of |S_x - dx| + |S_y - dy| over the cell, and so also of |S - middle - x dx - y dy|.
  double deviation = 0;
  double s = 0.5, t = 0.5, s_half = 0.5, t_half = 0.5;
  std::uint32_t patch = 0;
};

/// Cuts a patch into cells and appends them with their bounding boxes, computed from the convex hulls of their control points.
void cut(const Patch&, std::uint32_t number, std::vector<Cell>&, std::vector<Bounds3>&);

}  // namespace etendue::bezier
