#pragma once

#include <cmath>

#include "etendue/core/ray.h"

namespace etendue {

/// Finite-ray check: whether a ray's numbers are so small that squares of their sums are finite floats. For other rays slab
/// tests and Embree return arbitrary results, and Embree may end the program, so callers treat such a ray as hitting nothing.
inline bool has_finite_squares(const Ray& ray) {
  bool small = true;
  for (int k = 0; k < 3; ++k) small &= std::abs(ray.origin[k]) < 1e18f && std::abs(ray.direction[k]) < 1e18f;
  return small;
}

}  // namespace etendue
