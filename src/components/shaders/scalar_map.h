#pragma once
// Evaluation and checks of scalar maps (a roughness, an exponent, a rotation), for shaders.

#include <fmt/format.h>

#include "etendue/object_map.h"

namespace etendue {

/// A map's value at a point, clamped to [low, high]; not-a-number becomes `low`.
inline float scalar_at(const ObjectMap& map, const SurfacePoint& p, float low = 0, float high = 1) {
  const float x = map.scalar(p);
  return x > low ? std::min(x, high) : low;
}

/// Throws Error at the member if the map is missing, or if it is constant and out of range.
inline void require_scalar(const Component& owner, const char* member, const Ref<ObjectMap>& map, float low = 0,
                           float high = 1) {
  if (!map) owner.fail(member, "a map or a number is needed");
  const Color all = map->constant();
  if (!all) return;
  const float x = map->scalar(SurfacePoint());
  if (!(x >= low && x <= high)) owner.fail(member, fmt::format("must be from {:.9g} to {:.9g}, not {:.9g}", low, high, x));
}

}  // namespace etendue
