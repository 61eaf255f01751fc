#pragma once
// Bézier patches cut into cells, nearly flat and nearly parallelograms, on which Newton's method cannot fail.

#include <cstdint>

#include "bezier_patch.h"
#include "etendue/core/vector.h"

namespace etendue::bezier {

/// The part of a patch where |s - s_middle| <= s_half and the same in t. Its own coordinates x and y go from -1 to 1.
struct Cell {
  Vector middle, dx, dy;  ///< position and derivatives in the middle
  /// Bounds |S_x - dx| + |S_y - dy| over the cell, so also |S - middle - x dx - y dy|.
  double deviation = 0;
  double s = 0.5, t = 0.5, s_half = 0.5, t_half = 0.5;
  std::uint32_t patch = 0;
};

/// Cuts a patch into cells and appends them with their boxes, which the hulls of their control points give.
void cut(const Patch&, std::uint32_t number, std::vector<Cell>&, std::vector<Bounds3>&);

}  // namespace etendue::bezier
