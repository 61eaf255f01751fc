#pragma once
// SurfacePoint: a point on a surface, and the rays that leave it.

#include "etendue/core/ray.h"

namespace etendue {

class MediumStack;

/// The sides of a surface that emit, or that scatter.
enum class Sides : std::uint8_t { front, back, both };

/// A point on a surface (SurfaceInteraction in pbrt and Mitsuba), in the coordinates of the outermost scene; an object fills
/// it in those of the scene that contains it.
struct SurfacePoint {
  Point3 position;
  float error = 0;             ///< upper bound of the distance of `position` from the true surface [m]
  Normal3 normal;              ///< unit, geometric; points to the front side
  Normal3 shading_normal;      ///< unit; equals `normal` unless the object interpolates or a map perturbs it
  Point2 uv;                   ///< surface coordinates
  Vector3 dpdu, dpdv;          ///< derivatives of position by u and v; zero until SceneObject::tangents was called
  Point3 object_position;      ///< in object space
  Normal3 object_normal;       ///< unit, in object space
  float footprint = 0;         ///< width of the ray cone at the point, perpendicular to the ray [m]
  float footprint_cosine = 1;  ///< |cos| of ray and normal: on the surface the footprint is longer by 1/cos along one direction
  float time = 0;              ///< [s]
  const SceneObject* object = nullptr;
  std::uint32_t primitive = 0;
  float u = 0, v = 0;                  ///< copied from the Hit: coordinates on the primitive
  const MediumStack* media = nullptr;  ///< the media that contain the ray that hit the point; null: vacuum
  Vector3 ray_direction;               ///< of the ray that hit the point: the footprint is longer along it; zero: unknown

  /// A ray that leaves the surface without self-intersection: its origin is offset along the normal by the error bound.
  Ray leave(const Vector3& direction) const {
    Ray ray;
    leave(direction, ray);
    return ray;
  }
  /// The same, written into an existing ray (copying a ray that was just written would cause a store-forwarding stall).
  void leave(const Vector3& direction, Ray& ray) const {
    ray.origin = exit(direction);
    ray.direction = direction;
    ray.maximum = infinity;
    ray.time = time;
  }
  /// The offset origin of such a ray.
  Point3 exit(const Vector3& direction) const {
    return position + std::copysign(error, dot(normal, direction)) * Vector3(normal);
  }
  /// A ray of unit direction to another point, which ends just before that point: a shadow ray.
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
  /// Lets a ray end just before a point: on the ray's side of the point's surface, outside the error bound.
  [[gnu::always_inline]] static inline void end_at(const SurfacePoint& p, Ray& ray) {
    const Vector3 d = p.exit(ray.origin - p.position) - ray.origin;
    const float squared = length_squared(d), inverse = inverse_sqrt(squared);
    ray.direction = inverse * d;
    ray.maximum = squared * inverse * almost_there;
  }
  /// The fraction of the distance to a point at which shadow rays end, so that they do not hit the point's own surface:
  /// intersections are exact to a few units in the last place of the distance.
  static constexpr float almost_there = 1 - 2e-6f;
};

}  // namespace etendue
