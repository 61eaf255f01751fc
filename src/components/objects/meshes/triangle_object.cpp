#include "triangle_object.h"

#include "geometry/embree_device.h"
#include "geometry/geometry.h"
#include "geometry/triangle_test.h"
#include "geometry/watertight.h"

namespace etendue {
namespace {

/// Normalizes a cross product of edges without overflow or underflow.
Vector3 unit_normal(const Vector3& n, float& inverse_length) {
  const float nn = dot(n, n);
  if (nn > 1e-30f && nn < 1e30f) [[likely]] {
    inverse_length = 1 / std::sqrt(nn);
    return inverse_length * n;
  }
  const float largest = max_component(abs(n));
  if (!(largest > 0)) {  // a deforming triangle at a time at which it is degenerate
    inverse_length = 1e30f;
    return {0, 0, 1};
  }
  const float s = 1 / largest;
  const Vector3 m = s * n;
  const float l = 1 / length(m);
  inverse_length = std::min(s * l, 1e30f);
  return l * m;
}

}  // namespace

TriangleObject::TriangleObject() = default;
TriangleObject::~TriangleObject() = default;

Vector3 TriangleObject::stored_normal(std::uint32_t corner, const Moment& m) const {
  const Vector3 n(mesh_.normals[m.first + corner]);
  return motion_.moves() ? (1 - m.part) * n + m.part * Vector3(mesh_.normals[m.second + corner]) : n;
}

// Intersection uses the time as a fraction of the whole motion, with a rounding error of two units in the last place of 1:
// relative to one interval between keys, the error is larger the shorter the interval.
float TriangleObject::motion_error(std::uint32_t primitive, const Moment& m, const Normal3& n) const {
  const std::vector<float>& times = motion_.times;
  const size_t k = m.second / vertices_;
  const float steps = (times.back() - times.front()) / (times[k] - times[k - 1]);
  float furthest = 0, size = 0;
  for (const std::uint32_t c : mesh_.triangles[primitive]) {
    const Vector3 a = mesh_.positions[m.first + c] - Point3{}, b = mesh_.positions[m.second + c] - Point3{};
    furthest = std::max(furthest, along(n, abs(b - a)));
    size = std::max(size, along(n, abs(a) + abs(b)));
  }
  return 4 * rounding_bound(1) * steps * furthest + rounding_bound(4) * size;  // plus rounding of interpolation
}

TriangleObject::Corners TriangleObject::corners(std::uint32_t primitive, float time) const {
  Corners c = stored_corners(primitive, moment(time));
  if (transform.animated()) {
    const Transform moved = transform.at(time);
    for (Point3& p : c.p) p = moved(p);
    if (moved.flips()) std::swap(c.p[1], c.p[2]);
  }
  return c;
}

const EmbreeTriangles& TriangleObject::accelerator() const {
  std::call_once(lazy_->accelerator_made, [this] { lazy_->accelerator = std::make_unique<EmbreeTriangles>(moving_view()); });
  return *lazy_->accelerator;
}

bool TriangleObject::intersect(const Ray& ray, Hit& hit) const {
  const Ray local = transform.animated() ? ray_into(transform.at(ray.time), ray) : ray;
  TriangleHit found{ray.maximum, 0, 0};
  std::uint32_t primitive = 0;
  bool any = false;
  if (mesh_.triangles.size() > few) {
    any = accelerator().nearest(local, found.t, primitive, found.u, found.v);
  } else {
    const Moment now = moment(ray.time);
    const ShearedRay<double> sheared(local);
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Corners c = stored_corners(std::uint32_t(i), now);
      const auto corner = [&c](int k, int axis) { return double(c.p[k][axis]); };
      const CornerWeights<double> weights = corner_weights(sheared, corner);
      if (!inside(weights)) continue;
      const float t = float(plane_distance(sheared, corner));
      if (!(t > 0 && t < found.t)) continue;
      found = {t, float(weights.b / weights.sum()), float(weights.c / weights.sum())};
      primitive = std::uint32_t(i);
      any = true;
    }
  }
  if (!any) return false;
  hit.distance = found.t;
  hit.object = this;
  hit.primitive = primitive;
  hit.u = found.u;
  hit.v = found.v;
  hit.depth = 0;
  return true;
}

bool TriangleObject::occludes(const Ray& ray) const {
  if (mesh_.triangles.size() > few)
    return accelerator().any(transform.animated() ? ray_into(transform.at(ray.time), ray) : ray);
  Hit hit;
  return intersect(ray, hit);
}

// The error bounds the distance, along the normal N/|N|, of a point on the triangle from the plane as an intersection test
// computes it. With E = |e1| + |e2| and P = |v0| + E per axis: computing the point and offsetting it round coordinates of at
// most P (3 roundings); interpolation, v0 - O and the product with N round terms of at most E (8 roundings); and the error of
// N, up to 3 roundings of X_i = |e1_j e2_k| + |e1_k e2_j|, rotates the plane about v0, which matters at a distance of at most
// E. For slivers this last bound becomes too large to be useful, and is clamped.
TriangleObject::Plane TriangleObject::plane_of(const Point3& p0, const Vector3& e1, const Vector3& e2) {
  float inverse_length = 0;
  Plane plane;
  plane.normal = Normal3(unit_normal(cross(e1, e2), inverse_length));
  const Vector3 a = abs(e1), b = abs(e2), extent = a + b;
  const Vector3 x{a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
  const Vector3 furthest = Vector3{std::abs(p0.x), std::abs(p0.y), std::abs(p0.z)} + extent;
  const float longest = std::sqrt(std::max({dot(e1, e1), dot(e2, e2), length_squared(e2 - e1)}));
  plane.margin = std::min(border * max_component(furthest) * longest * inverse_length, 0.125f);
  plane.error = along(plane.normal, rounding_bound(3) * furthest + rounding_bound(8) * extent) +
                std::min(rounding_bound(3) * inverse_length * dot(x, extent), 1e-3f * (extent.x + extent.y + extent.z));
  return plane;
}

void TriangleObject::fill(std::uint32_t primitive, float u, float v, float time, SurfacePoint& p) const {
  if (!motion_.moves()) [[likely]]
    fill_at<false>(primitive, u, v, time, p);
  else
    fill_at<true>(primitive, u, v, time, p);
}

template <bool moving>
inline void TriangleObject::fill_at(std::uint32_t primitive, float u, float v, float time, SurfacePoint& p) const {
  const auto& t = mesh_.triangles[primitive];
  const Moment now = moving ? moment(time) : Moment{};
  Corners corners;
  if (moving) corners = stored_corners(primitive, now);
  const Point3& p0 = moving ? corners.p[0] : mesh_.positions[t[0]];
  const Vector3 e1 = (moving ? corners.p[1] : mesh_.positions[t[1]]) - p0;
  const Vector3 e2 = (moving ? corners.p[2] : mesh_.positions[t[2]]) - p0;
  float margin = 0;
  if (!planes_.empty()) {
    const Plane& plane = planes_[primitive];
    p.normal = plane.normal;
    p.error = plane.error;
    margin = plane.margin;
  } else {
    const Plane plane = plane_of(p0, e1, e2);
    p.normal = plane.normal;
    p.error = plane.error;
    margin = plane.margin;
  }
  if (std::min({u, v, 1 - u - v}) < margin) [[unlikely]] {
    u = std::max(u, margin);
    v = std::max(v, margin);
    const float inside = std::min(1.0f, (1 - margin) / (u + v));
    u *= inside;
    v *= inside;
  }
  if (moving) p.error += motion_error(primitive, now, p.normal);
  p.position = p0 + (u * e1 + v * e2);

  const float w = 1 - u - v;
  if (mesh_.normals.empty()) {
    p.shading_normal = p.normal;
  } else {
    const auto normal = [&](std::uint32_t corner) {
      return moving ? stored_normal(corner, now) : Vector3(mesh_.normals[corner]);
    };
    const Vector3 n0 = normal(t[0]), n1 = normal(t[1]), n2 = normal(t[2]);
    const Vector3 s = w * n0 + u * n1 + v * n2;
    const float ss = dot(s, s);
    const bool known = ss > 1e-12f && dot(n0, n0) > 0 && dot(n1, n1) > 0 && dot(n2, n2) > 0;
    p.shading_normal = known ? Normal3((1 / std::sqrt(ss)) * s) : p.normal;
    if (dot(p.shading_normal, p.normal) < 0) p.shading_normal = -p.shading_normal;
  }
  const auto& corner = uv_corners_[primitive & uv_mask_];
  const Point2 &a0 = uvs_[corner[0]], &a1 = uvs_[corner[1]], &a2 = uvs_[corner[2]];
  p.uv = {w * a0.x + u * a1.x + v * a2.x, w * a0.y + u * a1.y + v * a2.y};
  p.dpdu = {};
  p.dpdv = {};
  p.time = time;
  p.object = this;
  p.primitive = primitive;
  p.u = u;
  p.v = v;
  if (!transform.animated()) [[likely]] {
    fill_object_coordinates(transform, transform.still(), p);
  } else {
    p.object_position = object_position_of(transform, p.position);
    p.object_normal = p.normal;
    carry_out(transform.at(time), p);
  }
}

void TriangleObject::surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const {
  fill(hit.primitive, hit.u, hit.v, ray.time, p);
}

void TriangleObject::tangents(SurfacePoint& p) const {
  if (p.dpdu != Vector3{}) return;  // already set by a nested scene
  const auto& t = mesh_.triangles[p.primitive];
  const Corners corners = stored_corners(p.primitive, moment(p.time));
  Vector3 e1 = corners.p[1] - corners.p[0], e2 = corners.p[2] - corners.p[0];
  if (transform.animated()) {
    const Transform moved = transform.at(p.time);
    e1 = moved(e1);
    e2 = moved(e2);
  }
  p.dpdu = e1;
  p.dpdv = e2;
  if (mesh_.uvs.empty()) return;
  // e1 = du1 dpdu + dv1 dpdv and e2 = du2 dpdu + dv2 dpdv, solved.
  const Vector2 d1 = mesh_.uvs[t[1]] - mesh_.uvs[t[0]], d2 = mesh_.uvs[t[2]] - mesh_.uvs[t[0]];
  const float determinant = difference_of_products(d1.x, d2.y, d1.y, d2.x);
  if (determinant != 0 && std::isfinite(1 / determinant)) {
    p.dpdu = (d2.y * e1 - d1.y * e2) / determinant;
    p.dpdv = (d1.x * e2 - d2.x * e1) / determinant;
  } else {  // the uvs are degenerate: an arbitrary basis
    const Frame frame(p.normal);
    p.dpdu = frame.s;
    p.dpdv = frame.t;
  }
}

std::optional<TriangleView> TriangleObject::triangles() const {
  if (moves()) return std::nullopt;
  return view();
}

std::optional<MovingTriangleView> TriangleObject::moving_triangles() const {
  if (!motion_.moves() || transform.animated()) return std::nullopt;
  return moving_view();
}

}  // namespace etendue
