#pragma once
// Chooses the inner origin of a shape's transform, so that floats are precise near the shape.

#include <algorithm>
#include <span>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// The centre of the points' bounding box if they lie far from the origin, else the origin: floats are most precise near zero,
/// and a shape modelled around its own origin keeps it.
inline DoublePoint3 inner_origin_for(std::span<const DoublePoint3> places) {
  DoublePoint3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (const DoublePoint3& p : places)
    if (is_finite(p))
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
  double away = 0, extent = 0;
  for (int k = 0; k < 3; ++k) {
    away = std::max(away, std::abs(high[k] + low[k]) / 2);
    extent = std::max(extent, high[k] - low[k]);
  }
  // For points nearer to the origin than this, floats lose at most two bits.
  if (!(away > 4 * extent) || !(extent >= 0)) return {};
  return {(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
}

/// The points relative to an origin, in floats.
inline std::vector<Point3> relative_to(const DoublePoint3& origin, std::span<const DoublePoint3> places) {
  std::vector<Point3> shifted;
  shifted.reserve(places.size() + 1);  // one more, for the padding that meshes add
  for (const DoublePoint3& p : places) shifted.push_back(Point3(DoublePoint3{} + (p - origin)));
  return shifted;
}

}  // namespace etendue
