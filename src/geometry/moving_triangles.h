#pragma once
// A view of triangles with optional vertex motion, from which acceleration structures are built.

#include <algorithm>

#include "etendue/core/math.h"
#include "etendue/mesh_facts.h"

namespace etendue {

/// Triangles whose vertices move linearly between keyframes and rest before the first and after the last. `positions` stores
/// all vertices at the first key, then all at the second, and so on; it needs padding, since sixteen bytes are read at the last
/// position.
struct MovingTriangleView {
  std::span<const Point3> positions;
  size_t vertices = 0;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const float> times;  ///< [s], increasing; at least two, or none if nothing moves

  MovingTriangleView() = default;
  MovingTriangleView(const TriangleView& still)
      : positions(still.positions), vertices(still.positions.size()), triangles(still.triangles) {}
  MovingTriangleView(std::span<const Point3> at_keys, size_t count, std::span<const std::array<std::uint32_t, 3>> corners,
                     std::span<const float> keys)
      : positions(at_keys), vertices(count), triangles(corners), times(keys) {}

  /// The two keys around a time, given by the index of each key's first position, and the interpolation parameter between them.
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
