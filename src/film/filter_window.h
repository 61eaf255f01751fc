#pragma once
// FilterWindow: the pixels that a film point contributes to along one axis, and the cells of the film's filter table with their
// weights.

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {

inline constexpr float maximum_filter_radius = 16;

struct FilterWindow {
  int first = 0, count = 0;
  std::array<int, 2 * int(maximum_filter_radius) + 2> cells;  ///< table cell for each pixel, starting at `first`

  /// The pixels of [low, high) whose centres lie closer than the radius to a film coordinate. The coordinate must be
  /// finite and of ordinary size.
  FilterWindow(float film, float radius, int table_size, int low, int high) {
    const float x = film - 0.5f;  // in this coordinate pixel i has its centre at i
    first = std::max(low, int(std::floor(x - radius)) + 1);
    const int end = std::min(high, int(std::ceil(x + radius)));
    const float cells_per_pixel = float(table_size) / radius;
    for (int i = first; i < end; ++i)
      cells[size_t(count++)] = std::min(table_size - 1, int(std::abs(float(i) - x) * cells_per_pixel));
  }
};

}  // namespace etendue
