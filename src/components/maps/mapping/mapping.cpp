#include "mapping.h"

#include "geometry/geometry.h"

namespace etendue {

// Let a and b be the gradients of u and v, projected onto the tangent plane, and n the normal. The step that changes u by 1 and
// keeps v is along b x n: the tangents are the dual basis (b x n) / (n . (a x b)) and (n x a) / (n . (a x b)).
void set_uv(SurfacePoint& p, const Projected& to) {
  p.uv = to.uv;
  const Vector3 n(p.normal);
  Vector3 a = to.gradient_u - dot(to.gradient_u, n) * n, b = to.gradient_v - dot(to.gradient_v, n) * n;
  float aa = dot(a, a), bb = dot(b, b), d = dot(n, cross(a, b));
  if (!(aa + bb > 0) || !std::isfinite(aa + bb)) {  // (u, v) is constant here: any very long tangents
    const Frame frame(p.normal);
    p.dpdu = 1e6f * frame.s;
    p.dpdv = 1e6f * frame.t;
    return;
  }
  // Where the projection grazes the surface, a and b are parallel, as one combination of u and v is constant along the surface.
  // The shorter gradient is then replaced by a small one perpendicular to the other.
  constexpr float least = 1e-4f;
  if (!(std::abs(d) > least * std::max(aa, bb))) {
    if (aa >= bb)
      b = least * cross(n, a);
    else
      a = -least * cross(n, b);
    d = least * std::max(aa, bb);
  }
  p.dpdu = cross(b, n) / d;
  p.dpdv = cross(n, a) / d;
}

float turn_around_z(const Vector3& p, Vector3& gradient) {
  const float r2 = p.x * p.x + p.y * p.y;
  gradient = r2 > 0 ? (1 / (2 * pi * r2)) * Vector3{-p.y, p.x, 0} : Vector3{};
  float u = std::atan2(p.y, p.x) / (2 * pi);
  if (u < 0) u += 1;
  return u < 1 ? u : 0;
}

void ProjectionMap::prepare() {
  if (!map) fail("map", "a map is needed");
  if (!transform.valid()) fail("transform", "must be invertible");
}

SurfacePoint ProjectionMap::seen_at(const SurfacePoint& point) const {
  SurfacePoint p = point;
  Transform scratch, object_scratch;
  const Transform& t = placed(transform, p.time, scratch);
  Projected to = project(Point3(t.back(world ? world_position(p) : DoublePoint3(p.object_position))) - Point3{});
  // Gradients are transformed like normals.
  const auto out = [&](const Vector3& gradient) {
    const Normal3 g = t(Normal3(gradient));
    return Vector3(world ? g : placement(point, object_scratch)(g));
  };
  to.gradient_u = out(to.gradient_u);
  to.gradient_v = out(to.gradient_v);
  set_uv(p, to);
  return p;
}

}  // namespace etendue
