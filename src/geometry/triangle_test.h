#pragma once
// Intersection of one ray with one triangle.

#include "etendue/core/ray.h"

namespace etendue {

/// The triangle's unit normal times twice its area.
inline Vector3 area_vector(const Point3& a, const Point3& b, const Point3& c) { return cross(b - a, c - a); }

struct TriangleHit {
  float t, u, v;
};

/// Moeller & Trumbore 1997, with the triangle's normal. From O + t D = v0 + u e1 + v e2 and C = v0 - O, N = e1 x e2:
///   t = N.C / N.D,  u = e2.(C x D) / N.D,  v = -e1.(C x D) / N.D.
/// For a ray parallel to the plane the division by zero gives values that fail the comparisons.
inline bool intersect_triangle(const Ray& ray, const Point3& v0, const Vector3& e1, const Vector3& e2, const Vector3& n,
                               TriangleHit& hit) {
  const Vector3 c = v0 - ray.origin, r = cross(c, ray.direction);
  const float inverse = 1 / dot(n, ray.direction);
  hit.t = dot(n, c) * inverse;
  hit.u = dot(r, e2) * inverse;
  hit.v = -dot(r, e1) * inverse;
  return hit.u >= 0 && hit.v >= 0 && hit.u + hit.v <= 1 && hit.t > 0 && hit.t < ray.maximum;
}

}  // namespace etendue
