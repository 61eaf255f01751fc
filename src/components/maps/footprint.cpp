#include "footprint.h"

#include "etendue/scene_object.h"
#include "geometry/geometry.h"

namespace etendue {
namespace {

/// At grazing angles the ellipse's length is limited to this many times its width.
constexpr float longest = 64;

}  // namespace

Footprint footprint_of(const SurfacePoint& p) {
  if (!(p.footprint > 0)) return {};
  const Vector3 n(p.normal), d = p.ray_direction;
  const Vector3 along = d - dot(d, n) * n;
  const float sine2 = length_squared(along);
  if (!(sine2 > 1e-8f)) {  // perpendicular incidence, or an unknown ray direction: a circle
    const Frame frame(p.normal);
    return {p.footprint * frame.s, p.footprint * frame.t};
  }
  const Vector3 a = along / std::sqrt(sine2);
  return {p.footprint * std::min(1 / p.footprint_cosine, longest) * a, p.footprint * cross(n, a)};
}

Footprint object_footprint(const SurfacePoint& p) {
  const Footprint seen = footprint_of(p);
  Transform scratch;
  const Transform& t = placement(p, scratch);
  return {t.back(seen.longer), t.back(seen.shorter)};
}

// The ellipse's points are a cos t + b sin t. The derivative of their squared length, (b^2 - a^2) sin 2t + 2 a b cos 2t,
// vanishes at the major axis, and a quarter of a turn further at the minor axis.
void set_footprint(SurfacePoint& p, const Footprint& diameters) {
  const Vector3 &a = diameters.longer, &b = diameters.shorter;
  const float t = 0.5f * std::atan2(2 * dot(a, b), dot(a, a) - dot(b, b)), cosine = std::cos(t), sine = std::sin(t);
  const Vector3 major = cosine * a + sine * b;
  const float longer = length(major), shorter = length(cosine * b - sine * a);
  if (!(longer > 0 && longer < infinity)) return;
  p.footprint = shorter;
  p.footprint_cosine = std::min(shorter / longer, 1.0f);
  p.ray_direction = safe_sqrt(1 - square(p.footprint_cosine)) / longer * major - p.footprint_cosine * Vector3(p.normal);
}

void with_tangents(SurfacePoint& p) {
  if (p.dpdu == Vector3{} && p.dpdv == Vector3{} && p.object) p.object->tangents(p);
}

Vector2 UvFootprint::box() const { return {std::hypot(longer.x, shorter.x), std::hypot(longer.y, shorter.y)}; }

// A step s in the surface is du dpdu + dv dpdv. With the unit vectors a and b of the tangents, and c = a x b,
//   du |dpdu| = (s x b) . c / c^2   and   dv |dpdv| = (a x s) . c / c^2.
// Where the tangents do not span the surface (at a pole, on a triangle whose corners have collinear (u, v)) this cannot be
// solved. Then the footprint is taken as a circle, scaled by the lengths of the tangents that are not zero.
UvFootprint uv_footprint(const SurfacePoint& point) {
  if (!(point.footprint > 0)) return {};
  SurfacePoint p = point;
  with_tangents(p);
  const float length_u = length(p.dpdu), length_v = length(p.dpdv), longest_tangent = std::max(length_u, length_v);
  if (!(longest_tangent > 0)) return {};
  const auto circle = [&] {
    return UvFootprint{{p.footprint / (length_u > 0 ? length_u : longest_tangent), 0},
                       {0, p.footprint / (length_v > 0 ? length_v : longest_tangent)}};
  };
  if (!(length_u > 0 && length_v > 0)) return circle();
  const Vector3 a = p.dpdu / length_u, b = p.dpdv / length_v, c = cross(a, b);
  const float sine2 = dot(c, c);
  if (!(sine2 > 1e-12f)) return circle();
  const auto step = [&](const Vector3& s) {
    return Vector2{dot(cross(s, b), c) / (sine2 * length_u), dot(cross(a, s), c) / (sine2 * length_v)};
  };
  const Footprint f = footprint_of(p);
  return {step(f.longer), step(f.shorter)};
}

const Transform& placement(const SurfacePoint& p, Transform& scratch) {
  static const Transform identity;
  if (!p.object) return identity;
  const AnimatedTransform& transform = p.object->transform;
  const bool still = !transform.animated() && transform.inner_origin() == DoublePoint3{};
  if (!still) scratch = transform.from_origin(p.time);
  const Transform& own = still ? transform.still() : scratch;
  const Point3 there = own(p.object_position);
  const float size = std::max({std::abs(p.position.x), std::abs(p.position.y), std::abs(p.position.z)});
  if (distance_squared(there, p.position) <= square(1e-4f * size + 16 * p.error)) return own;
  SurfacePoint inner = p, outer = p;  // before and after the further transforms
  with_tangents(outer);
  inner.position = there;
  inner.normal = inner.shading_normal = normalize(own(p.object_normal));
  inner.dpdu = inner.dpdv = {};
  p.object->tangents(inner);
  const Vector3 u = own.back(inner.dpdu), v = own.back(inner.dpdv), n(p.object_normal), area = cross(u, v);
  const Vector3 outer_area = cross(outer.dpdu, outer.dpdv);
  const float a = dot(area, n);
  if (!(a * a > 0)) return own;
  // The linear map from u, v and n to dpdu, dpdv and the normal, which is scaled as the tangents are: the sum of the outer
  // products of these images with the dual basis of u, v, n.
  const float scale = std::sqrt(length(outer_area) / std::abs(a));
  const Vector3 m = scale * Vector3(p.normal), du = cross(v, n) / a, dv = cross(n, u) / a;
  Transform::Matrix matrix{};
  for (int row = 0; row < 3; ++row) {
    float moved = 0;
    for (int column = 0; column < 3; ++column) {
      const float x = outer.dpdu[row] * du[column] + outer.dpdv[row] * dv[column] + m[row] * n[column];
      matrix[size_t(4 * row + column)] = x;
      moved += x * p.object_position[column];
    }
    matrix[size_t(4 * row + 3)] = p.position[row] - moved;
  }
  scratch = Transform(matrix);
  return scratch.valid() ? scratch : identity;
}

SolidPoint solid_point(const SurfacePoint& p, MapSpace space, float size) {
  const float scale = 1 / size;
  SolidPoint s;
  // The ellipse's area is that of a circle 1 / sqrt(cos) times as wide as the ray.
  float width = p.footprint / std::sqrt(std::max(p.footprint_cosine, 1 / longest));
  switch (space) {
    case MapSpace::object: {
      s.at = p.object_position - Point3{};
      if (!(width > 0)) break;
      // The transform M scales an area with object-space normal n by det(M) |M^-T n|.
      Transform scratch;
      const Transform& t = placement(p, scratch);
      if (!t.identity()) width /= std::sqrt(t.area_stretch(p.object_normal));
      break;
    }
    case MapSpace::world: s.at = Point3(world_position(p)) - Point3{}; break;
    case MapSpace::uv: {
      s.at = {p.uv.x, p.uv.y, 0};
      if (!(width > 0)) break;
      SurfacePoint copy = p;
      with_tangents(copy);
      const float area = length(cross(copy.dpdu, copy.dpdv));
      width = area > 0 ? width / std::sqrt(area) : 0;
      break;
    }
  }
  s.at = scale * s.at;
  s.width = width > 0 && width < infinity ? scale * width : 0;
  return s;
}

}  // namespace etendue
