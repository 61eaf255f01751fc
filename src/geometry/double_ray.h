#pragma once
// DoubleRay: a ray in double precision, for root finders.

#include "etendue/core/ray.h"

namespace etendue {

/// A float's rounding error at a distance is relative to that distance, not to the size of the shape.
struct DoubleRay {
  double origin[3], direction[3];  ///< the direction is not normalized
  double maximum;
  explicit DoubleRay(const Ray& r)
      : origin{double(r.origin.x), double(r.origin.y), double(r.origin.z)},
        direction{double(r.direction.x), double(r.direction.y), double(r.direction.z)},
        maximum(double(r.maximum)) {}
  double at(double t, int k) const { return origin[k] + t * direction[k]; }
};

}  // namespace etendue
