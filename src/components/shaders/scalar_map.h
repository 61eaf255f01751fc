#pragma once
// What shaders ask of a map of numbers (a roughness, an exponent, a rotation).

#include <fmt/format.h>

#include "etendue/object_map.h"

namespace etendue {

/// A map's number at a point, kept within [low, high] whatever the map holds; what is not a number becomes `low`.
inline float scalar_at(const ObjectMap& map, const SurfacePoint& p, float low = 0, float high = 1) {
  const float x = map.scalar(p);
  return x > low ? std::min(x, high) : low;
}

/// Throws at the member when the map is missing, or is the same everywhere and out of range.
inline void require_scalar(const Component& owner, const char* member, const Ref<ObjectMap>& map, float low = 0,
                           float high = 1) {
  if (!map) owner.fail(member, "a map or a number is needed");
  const Color all = map->constant();
  if (!all) return;
  const float x = map->scalar(SurfacePoint());
  if (!(x >= low && x <= high)) owner.fail(member, fmt::format("must be from {:.9g} to {:.9g}, not {:.9g}", low, high, x));
}

}  // namespace etendue
