#pragma once
// Rays, what they hit, and points on surfaces.

#include <array>

#include "etendue/core/vector.h"

namespace etendue {

class SceneObject;
class MediumStack;

/// Points on a ray are origin + t * direction for t in (0, maximum). The direction has unit length in the scene a
/// renderer sees; inside objects and nested scenes it is transformed, not normalized, so that t stays the same.
struct Ray {
  Point3 origin;
  Vector3 direction;
  float maximum = infinity;
  float time = 0;  ///< [s]
  /// A cone around the ray, for filtering maps: width [m] at the origin and its growth per distance (Akenine-Möller
  /// et al. 2021, "Improved shader and texture level of detail using ray cones").
  float width = 0, spread = 0;
  /// Joins the camera to what it sees first, whichever way it goes: what the camera is not to see is not there
  /// (SceneObject::visible_to_camera).
  bool of_camera = false;

  Point3 operator()(float t) const { return origin + t * direction; }
};

/// What an intersection found: enough to find everything else on demand.
struct Hit {
  static constexpr int deepest_nesting = 8;

  float distance = infinity;                   ///< t along the ray
  const SceneObject* object = nullptr;         ///< the innermost object; null when nothing was hit
  std::uint32_t primitive = 0;                 ///< part of the object (a triangle of a mesh)
  float u = 0, v = 0;                          ///< coordinates on the part, as the object defines them
  int depth = 0;                               ///< how many nested scenes the object lies in
  const SceneObject* scenes[deepest_nesting];  ///< those scenes, innermost first; only `depth` of them are set

  explicit operator bool() const { return object != nullptr; }
};

/// A point on a surface, in the coordinates of the scene the renderer sees.
struct SurfacePoint {
  Point3 position;
  float error = 0;             ///< bound of the distance of `position` from the true surface [m]
  Normal3 normal;              ///< unit, geometric; points to the front
  Normal3 shading_normal;      ///< unit; equals `normal` unless the object interpolates or a map perturbs it
  Point2 uv;                   ///< surface coordinates
  Vector3 dpdu, dpdv;          ///< change of position with uv; zero until the object's `tangents` was asked
  Point3 object_position;      ///< before the object's transform
  Normal3 object_normal;       ///< unit, before the object's transform
  float footprint = 0;         ///< width of the ray's cone here, across the ray [m]
  float footprint_cosine = 1;  ///< between the ray and the normal: the footprint is this much longer along one direction
  float time = 0;              ///< [s]
  const SceneObject* object = nullptr;
  std::uint32_t primitive = 0;
  float u = 0, v = 0;                  ///< of the hit
  const MediumStack* media = nullptr;  ///< media around the ray that came here; null: vacuum
  Vector3 ray_direction;               ///< of the ray that came here: the footprint is longer along it; zero: unknown

  /// A ray that leaves the surface without meeting it again: the origin is moved along the normal beyond the error.
  Ray leave(const Vector3& direction) const {
    Ray ray;
    leave(direction, ray);
    return ray;
  }
  /// The same into a ray that is there already (a copy of what was just written would wait for it).
  void leave(const Vector3& direction, Ray& ray) const {
    ray.origin = exit(direction);
    ray.direction = direction;
    ray.maximum = infinity;
    ray.time = time;
  }
  /// Where such a ray begins.
  Point3 exit(const Vector3& direction) const {
    return position + std::copysign(error, dot(normal, direction)) * Vector3(normal);
  }
  /// A ray to another point, of unit direction, that ends just before it.
  Ray towards(const SurfacePoint& p) const {
    Ray ray;
    towards(p, ray);
    return ray;
  }
  [[gnu::always_inline]] inline void towards(const SurfacePoint& p, Ray& ray) const {
    ray.origin = exit(p.position - position);
    end_at(p, ray);
    ray.time = time;
  }
  /// Lets a ray end just before a point: on its side of that surface, beyond the error.
  [[gnu::always_inline]] static inline void end_at(const SurfacePoint& p, Ray& ray) {
    const Vector3 d = p.exit(ray.origin - p.position) - ray.origin;
    const float squared = length_squared(d), inverse = inverse_sqrt(squared);
    ray.direction = inverse * d;
    ray.maximum = squared * inverse * almost_there;
  }
  /// What part of the way to a point is free of it for sure: intersections are exact to a few units in the last place of
  /// the distance.
  static constexpr float almost_there = 1 - 2e-6f;
};

}  // namespace etendue
