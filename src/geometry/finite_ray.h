#pragma once

#include <cmath>

#include "etendue/core/ray.h"

namespace etendue {

/// Whether a ray is made of numbers small enough that squares of their sums are floats. What is searched by slabs or with
/// Embree answers others as it likes, or ends the program: such a ray meets nothing.
inline bool has_finite_squares(const Ray& ray) {
  bool small = true;
  for (int k = 0; k < 3; ++k) small &= std::abs(ray.origin[k]) < 1e18f && std::abs(ray.direction[k]) < 1e18f;
  return small;
}

}  // namespace etendue
