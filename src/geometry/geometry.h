#pragma once
// Functions that several shapes share: transforms between world space and object space, and bounds of rounding errors.

#include "etendue/scene_object.h"

namespace etendue {

/// The transform at a time; `scratch` stores it if the object moves.
inline const Transform& placed(const AnimatedTransform& transform, float time, Transform& scratch) {
  if (!transform.animated()) [[likely]]
    return transform.still();
  scratch = transform.at(time);
  return scratch;
}

/// Converts a point given relative to the transform's inner origin to object space.
inline Point3 object_position_of(const AnimatedTransform& transform, const Point3& p) {
  return transform.inner_origin() == DoublePoint3{} ? p : Point3(transform.inner_origin() + (DoublePoint3(p) - DoublePoint3{}));
}

/// Sets the transform's inner origin to the scene's origin, transformed to object space. An identity transform then remains an
/// identity, and points that several objects place at the same position round to the same floats.
inline void use_scene_origin(AnimatedTransform& transform) {
  const Transform& first = transform.keys().front().transform;
  const bool far = transform.outer_origin() != DoublePoint3{};
  const DoublePoint3 own = far && first.valid() ? first.back(transform.outer_origin()) : DoublePoint3{};
  transform.set_inner_origin(is_finite(own) ? own : DoublePoint3{});
}

/// The bounding box of a box over the whole motion of its object.
inline Bounds3 swept(const AnimatedTransform& transform, const Bounds3& box) {
  return transform.sweep(box, transform.keys().front().time, transform.keys().back().time);
}

/// The bounds of an object whose box in object space is given: over its whole motion, and enlarged, as rounding may move points
/// out of the exact box.
inline Bounds3 bounds_of(const AnimatedTransform& transform, const Bounds3& box) {
  Bounds3 bounds = transform.animated() ? swept(transform, box) : transform.still()(box);
  const Vector3 margin = rounding_bound(8) * (bounds.diagonal() + abs(bounds.centre() - Point3{}));
  bounds.low = bounds.low - margin;
  bounds.high = bounds.high + margin;
  return bounds;
}

/// The bounding box of an unbounded object.
inline Bounds3 endless_box() {
  Bounds3 box;
  box.add(Point3{-SceneObject::endless, -SceneObject::endless, -SceneObject::endless});
  box.add(Point3{SceneObject::endless, SceneObject::endless, SceneObject::endless});
  return box;
}

/// The ray in object space. The direction is not normalized, so that t stays the same.
inline Ray ray_into(const Transform& transform, const Ray& ray) {
  Ray local = ray;
  local.origin = transform.back(ray.origin);
  local.direction = transform.back(ray.direction);
  return local;
}

/// A world-space normal transformed to object space (by the transpose of the matrix), not normalized.
inline Normal3 normal_into(const Transform& transform, const Normal3& n) {
  const auto& m = transform.matrix();
  return {m[0] * n.x + m[4] * n.y + m[8] * n.z, m[1] * n.x + m[5] * n.y + m[9] * n.z, m[2] * n.x + m[6] * n.y + m[10] * n.z};
}

/// Fills object_position and object_normal of a point whose world-space fields are set; `now` is the object's transform at the
/// point's time.
inline void fill_object_coordinates(const AnimatedTransform& transform, const Transform& now, SurfacePoint& p) {
  if (now.shifts_only()) [[likely]] {
    p.object_position = object_position_of(transform, p.position + now.shift_back());
    p.object_normal = p.normal;
  } else {
    p.object_position = object_position_of(transform, now.back(p.position));
    p.object_normal = normalize(normal_into(now, p.normal));
  }
}

/// The least distance of a surface's points from the surface's edges, relative to the largest coordinate at the point. A point
/// nearer to an edge may be rounded to the far side of the adjacent surface, and a ray that leaves it would start outside a
/// closed room. Rounding moves the point by 3 units of 2^-24 along each axis; the hit distance of the adjacent surface, and the
/// offset of a ray's origin from this surface, have errors of the same size. The value is twice the sum of these errors, which
/// allows for surfaces that meet at 30 degrees.
constexpr float border = rounding_bound(16);

/// sum |n_k| x_k: the displacement along the normal that errors of x_k along the axes cause at most.
inline float along(const Normal3& n, const Vector3& x) {
  return std::abs(n.x) * x.x + std::abs(n.y) * x.y + std::abs(n.z) * x.z;
}

/// Transforms a point from object space to world space. An error e along the normal becomes e / |M^-T n| along the new normal;
/// the rounding errors of this transform and of transforming the next ray back into object space are added.
inline void carry_out(const Transform& transform, SurfacePoint& p) {
  const Point3 inside = p.position;
  p.position = transform(inside);
  const Normal3 n = transform(p.normal);
  const float stretch = length(Vector3(n));
  const bool flat = p.shading_normal == p.normal;
  p.normal = Normal3(Vector3(n) / stretch);
  p.shading_normal = flat ? p.normal : normalize(transform(p.shading_normal));
  p.dpdu = transform(p.dpdu);
  p.dpdv = transform(p.dpdv);
  const Vector3 back = transform.error_bound_back(p.position);
  p.error = p.error / stretch + 2 * along(p.normal, transform.error_bound(inside, back));
}

/// The scale factor of a similarity transform; 0 if the transform is not a similarity.
inline float similarity_scale(const Transform& transform) {
  const auto& m = transform.matrix();
  const Vector3 x{m[0], m[4], m[8]}, y{m[1], m[5], m[9]}, z{m[2], m[6], m[10]};
  const float xx = dot(x, x), yy = dot(y, y), zz = dot(z, z), tolerance = 2e-6f * xx;
  const bool similar = std::abs(yy - xx) < tolerance && std::abs(zz - xx) < tolerance && std::abs(dot(x, y)) < tolerance &&
                       std::abs(dot(y, z)) < tolerance && std::abs(dot(z, x)) < tolerance;
  return similar ? std::sqrt(xx) : 0;
}

/// Fills direction, distance and the pdf [1/sr] of a point sampled with the pdf `area_pdf` per area [1/m^2].
inline void complete_by_area(SurfaceSample& s, const Point3& from, float area_pdf) {
  const Vector3 to = s.point.position - from;
  const float d2 = length_squared(to);
  if (!(d2 > 0)) {
    s.pdf = 0;
    return;
  }
  // d^2 / cosine is computed as (d^2 / across) * distance, where only the last factor depends on the square root: this shortens
  // the dependency chain.
  const float across = std::abs(dot(s.point.normal, to));
  const float inverse = inverse_sqrt(d2);
  s.distance = d2 * inverse;
  s.direction = inverse * to;
  s.pdf = across > 0 ? area_pdf * (d2 / across) * s.distance : 0;
}

/// Fills direction and distance of a point sampled with the pdf `pdf` [1/sr].
inline void complete_by_angle(SurfaceSample& s, const Point3& from, float pdf) {
  const Vector3 to = s.point.position - from;
  s.distance = length(to);
  s.pdf = s.distance > 0 ? pdf : 0;
  s.direction = s.distance > 0 ? to / s.distance : Vector3{0, 0, 1};
}

/// atan2(y, x) in [0, 2 pi), error below 1e-6; it takes a quarter of the time of the standard library's function. Polynomial:
/// Abramowitz & Stegun 1964, 4.4.49.
inline float positive_atan2(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float high = std::max(ax, ay), low = std::min(ax, ay);
  const float t = high > 0 ? low / high : 0, s = t * t;
  float a = 0.0028662257f;
  a = a * s - 0.0161657367f;
  a = a * s + 0.0429096138f;
  a = a * s - 0.0752896400f;
  a = a * s + 0.1065626393f;
  a = a * s - 0.1420889944f;
  a = a * s + 0.1999355085f;
  a = a * s - 0.3333314528f;
  a = t + t * s * a;
  if (ay > ax) a = pi / 2 - a;
  if (x < 0) a = pi - a;
  if (y < 0) a = 2 * pi - a;
  return a;
}

}  // namespace etendue
