#pragma once
// What several objects share: going in and out of an object's coordinates, and bounds of rounding errors.

#include "etendue/scene_object.h"
#include "etendue/shader.h"  // objects own shaders

namespace etendue {

/// The transform at a time; `scratch` holds it when the object moves.
inline const Transform& placed(const AnimatedTransform& transform, float time, Transform& scratch) {
  if (!transform.animated()) [[likely]]
    return transform.still();
  scratch = transform.at(time);
  return scratch;
}

/// Where what an object counts from its own `inner` point is in its own coordinates.
inline Point3 own_place(const AnimatedTransform& transform, const Point3& counted) {
  return transform.inner() == DoublePoint3{} ? counted : Point3(transform.inner() + (DoublePoint3(counted) - DoublePoint3{}));
}

/// Lets an object count its own places from where the scene counts from: a transform that does nothing does nothing then
/// either, and what several objects say to be in one place is in one place.
inline void count_with_scene(AnimatedTransform& transform) {
  const Transform& first = transform.keys().front().transform;
  const bool far = transform.outer() != DoublePoint3{};
  const DoublePoint3 own = far && first.valid() ? first.back(transform.outer()) : DoublePoint3{};
  transform.count_from(transform.outer(), is_finite(own) ? own : DoublePoint3{});
}

/// A box over the whole time an object moves.
inline Bounds3 swept(const AnimatedTransform& transform, const Bounds3& box) {
  return transform.sweep(box, transform.keys().front().time, transform.keys().back().time);
}

/// The bounds of what has no end.
inline Bounds3 endless_box() {
  Bounds3 box;
  box.add(Point3{-SceneObject::endless, -SceneObject::endless, -SceneObject::endless});
  box.add(Point3{SceneObject::endless, SceneObject::endless, SceneObject::endless});
  return box;
}

/// The ray in the object's coordinates. The direction is not normalized, so that t stays the same.
inline Ray ray_into(const Transform& transform, const Ray& ray) {
  Ray local = ray;
  local.origin = transform.back(ray.origin);
  local.direction = transform.back(ray.direction);
  return local;
}

/// The object's normal for a normal outside (by the transpose of the matrix), not normalized.
inline Normal3 normal_into(const Transform& transform, const Normal3& n) {
  const auto& m = transform.matrix();
  return {m[0] * n.x + m[4] * n.y + m[8] * n.z, m[1] * n.x + m[5] * n.y + m[9] * n.z, m[2] * n.x + m[6] * n.y + m[10] * n.z};
}

/// Fills object_position and object_normal of a point that is known outside; `now` is the object's transform at its time.
inline void fill_object_coordinates(const AnimatedTransform& transform, const Transform& now, SurfacePoint& p) {
  if (now.shifts_only()) [[likely]] {
    p.object_position = own_place(transform, p.position + now.shift_back());
    p.object_normal = p.normal;
  } else {
    p.object_position = own_place(transform, now.back(p.position));
    p.object_normal = normalize(normal_into(now, p.normal));
  }
}

/// How far from a surface's own border its points stay, in parts of the largest coordinate there. A point nearer to an edge may
/// be rounded to the other side of the surface that joins there, and a ray that leaves it would be outside of a closed room.
/// Rounding moves it by 3 units of 2^-24 along each axis; the other surface is found, and a ray's origin moved off this one,
/// within as much: twice their sum, which allows for surfaces that meet at 30 degrees.
constexpr float border = rounding_bound(16);

/// sum |n_k| x_k: how far an error of x_k along each axis moves a point along the normal.
inline float along(const Normal3& n, const Vector3& x) {
  return std::abs(n.x) * x.x + std::abs(n.y) * x.y + std::abs(n.z) * x.z;
}

/// Carries a point out through a transform. A distance e along the normal becomes e / |M^-T n| along the new one; to
/// that come the rounding of this step and of taking the next ray back in.
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

/// By how much a transform enlarges volumes; negative when it mirrors.
inline float linear_determinant(const Transform& transform) {
  const auto& m = transform.matrix();
  return dot(cross(Vector3{m[0], m[4], m[8]}, Vector3{m[1], m[5], m[9]}), Vector3{m[2], m[6], m[10]});
}

/// By how much a similarity enlarges; 0 when the transform is none.
inline float similarity_scale(const Transform& transform) {
  const auto& m = transform.matrix();
  const Vector3 x{m[0], m[4], m[8]}, y{m[1], m[5], m[9]}, z{m[2], m[6], m[10]};
  const float xx = dot(x, x), yy = dot(y, y), zz = dot(z, z), tolerance = 2e-6f * xx;
  const bool similar = std::abs(yy - xx) < tolerance && std::abs(zz - xx) < tolerance && std::abs(dot(x, y)) < tolerance &&
                       std::abs(dot(y, z)) < tolerance && std::abs(dot(z, x)) < tolerance;
  return similar ? std::sqrt(xx) : 0;
}

/// Direction, distance and the density [1/sr] of a point chosen with a density per area [1/m^2].
inline void complete_by_area(SurfaceSample& s, const Point3& from, float area_pdf) {
  const Vector3 to = s.point.position - from;
  const float d2 = length_squared(to);
  if (!(d2 > 0)) {
    s.pdf = 0;
    return;
  }
  // cosine / d^2 of the angle with the normal, with nothing in it that waits for the square root.
  const float across = std::abs(dot(s.point.normal, to));
  const float inverse = inverse_sqrt(d2);
  s.distance = d2 * inverse;
  s.direction = inverse * to;
  s.pdf = across > 0 ? area_pdf * (d2 / across) * s.distance : 0;
}

/// Direction and distance of a point chosen with a density [1/sr].
inline void complete_by_angle(SurfaceSample& s, const Point3& from, float pdf) {
  const Vector3 to = s.point.position - from;
  s.distance = length(to);
  s.pdf = s.distance > 0 ? pdf : 0;
  s.direction = s.distance > 0 ? to / s.distance : Vector3{0, 0, 1};
}

/// atan2(y, x) in [0, 2 pi), error below 1e-6; a quarter of the time of the library's. Polynomial: Abramowitz & Stegun
/// 1964, 4.4.49.
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
