#pragma once
// MediumInterval: the part of a ray that lies in a medium.

#include "etendue/transport/medium.h"

namespace etendue {

/// From `begin` to `end` [m] along the ray; empty if the ray misses the medium.
struct MediumInterval {
  float begin = 0, end = 0;
  float length() const { return end - begin; }
  /// The ray with its origin at `begin`.
  Ray within(const Ray& ray) const {
    Ray from = ray;
    if (begin > 0) from.origin = ray(begin);
    return from;
  }
};

/// The part of a ray in a medium, for a ray that a surface ends at `reach` [m], or that nothing ends (infinity): then up to the
/// bounding box of the medium's object. Bounded surroundings fill their sphere only, wherever the ray starts.
MediumInterval medium_interval(const Medium&, const Ray&, float reach);

}  // namespace etendue
