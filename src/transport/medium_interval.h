#pragma once
// MediumInterval: where along a ray a medium is.

#include "etendue/transport/medium.h"

namespace etendue {

/// From `begin` to `end` [m] of the ray; of a medium that the ray passes by, nothing.
struct MediumInterval {
  float begin = 0, end = 0;
  float length() const { return end - begin; }
  /// The ray from where it comes in.
  Ray within(const Ray& ray) const {
    Ray from = ray;
    if (begin > 0) from.origin = ray(begin);
    return from;
  }
};

/// Where a medium is of a ray that something ends at `reach` [m], or nothing (infinity): as far as its object's bounds; of
/// surroundings that have an end within their sphere alone, wherever the ray begins.
MediumInterval medium_interval(const Medium&, const Ray&, float reach);

}  // namespace etendue
