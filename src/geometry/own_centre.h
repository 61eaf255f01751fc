#pragma once
// The point that an object counts places of its own from: floats are fine near to it.

#include <algorithm>
#include <span>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// The middle of some places when they lie far from the origin, else the origin: floats near to zero are finer than elsewhere,
/// and what has its own zero shall keep that.
inline DoublePoint3 own_centre(std::span<const DoublePoint3> places) {
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
  // Nearer than this, floats lose no more than two bits.
  if (!(away > 4 * extent) || !(extent >= 0)) return {};
  return {(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
}

/// Places counted from a point, in floats.
inline std::vector<Point3> counted_from(const DoublePoint3& centre, std::span<const DoublePoint3> places) {
  std::vector<Point3> counted;
  counted.reserve(places.size() + 1);  // one more, for the padding that meshes add
  for (const DoublePoint3& p : places) counted.push_back(Point3(DoublePoint3{} + (p - centre)));
  return counted;
}

}  // namespace etendue
