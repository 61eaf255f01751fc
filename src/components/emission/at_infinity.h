#pragma once
// The emission of points at infinity.

#include "etendue/emission_shader.h"
#include "etendue/scene_object.h"

namespace etendue {

/// A point at infinity emits in one direction only, from the point towards the object's origin, with probability 1.
inline DirectionSample sample_at_infinity(const SurfacePoint& p) {
  Vector3 away = Point3{} - p.object_position;
  if (p.object) away = normalize(p.object->transform.at(p.time)(away));
  return {away, 1};
}

}  // namespace etendue
