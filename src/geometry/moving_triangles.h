#pragma once
// Triangles that may change their shape with time, as structures over them see them.

#include <algorithm>

#include "etendue/core/math.h"
#include "etendue/scene_object.h"

namespace etendue {

/// Triangles whose corners move in straight lines between the times of keys, and rest before the first and after the last.
/// The positions of all corners at the first key come first, then those at the second; sixteen bytes are read at the last.
struct MovingTriangleView {
  std::span<const Point3> positions;
  size_t vertices = 0;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const float> times;  ///< [s], increasing; two at least, or none: nothing moves

  MovingTriangleView() = default;
  MovingTriangleView(const TriangleView& still)
      : positions(still.positions), vertices(still.positions.size()), triangles(still.triangles) {}
  MovingTriangleView(std::span<const Point3> at_keys, size_t count, std::span<const std::array<std::uint32_t, 3>> corners,
                     std::span<const float> keys)
      : positions(at_keys), vertices(count), triangles(corners), times(keys) {}

  /// Two keys, as where their corners begin among the positions, and how far it is from one to the other.
  struct Moment {
    size_t first = 0, second = 0;
    float part = 0;
  };
  Moment moment(float time) const {
    if (times.empty()) [[likely]]
      return {};
    const auto next = std::upper_bound(times.begin() + 1, times.end() - 1, time);
    const size_t k = size_t(next - times.begin());
    return {(k - 1) * vertices, k * vertices, clamp((time - times[k - 1]) / (times[k] - times[k - 1]), 0, 1)};
  }
  Point3 position(std::uint32_t corner, const Moment& m) const {
    if (times.empty()) [[likely]]
      return positions[corner];
    return lerp(m.part, positions[m.first + corner], positions[m.second + corner]);
  }
};

}  // namespace etendue
