#pragma once
// Watertight ray-triangle intersection: no ray passes between triangles that share an edge or a vertex (Woop, Benthin & Wald
// 2013, "Watertight ray/triangle intersection"). For one triangle in double or for several in float.

#include "etendue/core/ray.h"
#include "lanes.h"

namespace etendue {

template <class Number>
struct ScalarOf {
  using Type = Number;
};
template <>
struct ScalarOf<Floats> {
  using Type = float;
};

/// A ray, and the shear that aligns it with the axis of its largest direction component. `Number` is double or Floats.
template <class Number>
struct ShearedRay {
  using Scalar = typename ScalarOf<Number>::Type;

  int x, y, z;  ///< z: the axis along the ray
  Number ox, oy, oz, dx, dy, dz;
  Number shear_x, shear_y, inverse_z;

  explicit ShearedRay(const Ray& ray) {
    const Vector3 size = abs(ray.direction);
    z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    x = z == 2 ? 0 : z + 1;
    y = x == 2 ? 0 : x + 1;
    ox = Scalar(ray.origin[x]) - Number{};
    oy = Scalar(ray.origin[y]) - Number{};
    oz = Scalar(ray.origin[z]) - Number{};
    dx = Scalar(ray.direction[x]) - Number{};
    dy = Scalar(ray.direction[y]) - Number{};
    dz = Scalar(ray.direction[z]) - Number{};
    const Scalar inverse = 1 / Scalar(ray.direction[z]);
    inverse_z = inverse - Number{};
    shear_x = dx * inverse;
    shear_y = dy * inverse;
  }
};

/// Barycentric coordinates, not normalized, of the point where a ray crosses a triangle's plane, and their sum. Inside the
/// triangle no two of them have opposite signs; all are zero for a triangle seen edge on.
template <class Number>
struct CornerWeights {
  Number a, b, c;
  Number sum() const { return a + b + c; }
};

// With the corners relative to the origin and sheared, the ray is the z axis, and the weight of a corner is twice the area that
// the z axis and the other two span in the xy plane. A vertex is projected in the same way for each triangle that it belongs
// to, and the areas have exact signs (see signed_difference): so the projected triangles tile the plane without gaps, and a ray
// just outside one triangle's edge is inside the neighbour at this edge.
/// `corner(k, axis)` gives the coordinates of corner k.
template <class Number, class Corner>
inline CornerWeights<Number> corner_weights(const ShearedRay<Number>& r, const Corner& corner) {
  Number x[3], y[3];
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    const Number z = corner(k, r.z) - r.oz;
    x[k] = minus_product(corner(k, r.x) - r.ox, r.shear_x, z);
    y[k] = minus_product(corner(k, r.y) - r.oy, r.shear_y, z);
  }
  return {signed_difference(x[2], y[1], y[2], x[1]), signed_difference(x[0], y[2], y[0], x[2]),
          signed_difference(x[1], y[0], y[1], x[0])};
}

// t = N.(A - O) / N.D with the normal N, the formula whose rounding SurfacePoint::error of triangles bounds: a ray that leaves
// a triangle does not hit it again (which would happen if t were interpolated from the vertices' depths). The depths only clamp
// t: edge on, N.D may have the wrong sign or be zero, but the hit must not be lost, or the mesh would leak.
template <class Number, class Corner>
inline Number plane_distance(const ShearedRay<Number>& r, const Corner& corner) {
  const Number ax = corner(0, r.x), ay = corner(0, r.y), az = corner(0, r.z);
  const Number ux = corner(1, r.x) - ax, uy = corner(1, r.y) - ay, uz = corner(1, r.z) - az;
  const Number vx = corner(2, r.x) - ax, vy = corner(2, r.y) - ay, vz = corner(2, r.z) - az;
  const Number nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const Number t = (nx * (ax - r.ox) + ny * (ay - r.oy) + nz * (az - r.oz)) / (nx * r.dx + ny * r.dy + nz * r.dz);
  const Number a = (az - r.oz) * r.inverse_z, b = (corner(1, r.z) - r.oz) * r.inverse_z,
               c = (corner(2, r.z) - r.oz) * r.inverse_z;
  return smaller(larger(t, smaller(smaller(a, b), c)), larger(larger(a, b), c));
}

/// Whether the ray's line goes through the triangle.
inline bool inside(const CornerWeights<double>& w) {
  const bool negative = w.a < 0 || w.b < 0 || w.c < 0, positive = w.a > 0 || w.b > 0 || w.c > 0;
  return negative != positive;
}
inline LaneBits inside(const CornerWeights<Floats>& w) {
  const Floats zero{};
  const LaneBits negative = less(w.a, zero) | less(w.b, zero) | less(w.c, zero);
  const LaneBits positive = less(zero, w.a) | less(zero, w.b) | less(zero, w.c);
  return negative ^ positive;
}

}  // namespace etendue
