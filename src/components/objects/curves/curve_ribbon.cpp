#include "curve_ribbon.h"

namespace etendue {

// With the ray's origin at 0, the ray intersects the line from a(u) = p(u, 0) along e(u) = p(u, 1) - p(u, 0) where
//   (a(u) x d).e(u) = 0,
// a quadratic in u (Reshetov 2019, "Cool patches: a geometric approach to ray/bilinear patch intersections"); then, with
// n = d x e,  v = (a x d).n / n^2  and  t = (a x e).n / n^2.
bool RibbonPiece::intersect(const DoubleRay& ray, float maximum, float& t, float& u, float& v) const {
  const Double3 d(ray.direction), o = Double3(ray.origin) - p_;
  const double start = dot(0.5 * axis_ - o, d) / dot(d, d);
  const Double3 q = o + start * d;
  const Double3 a0 = -1.0 * (q + side0_), da = axis_ - (side1_ - side0_), e0 = 2 * side0_, de = 2 * (side1_ - side0_);
  const Double3 a0d = cross(a0, d), dad = cross(da, d);
  const double qc = dot(a0d, e0), qb = dot(a0d, de) + dot(dad, e0), qa = dot(dad, de);
  const double discriminant = qb * qb - 4 * qa * qc;
  if (!(discriminant >= 0)) return false;
  const double root = -0.5 * (qb + std::copysign(std::sqrt(discriminant), qb));
  constexpr double slack = 1e-9;  // better to hit a point twice, once on each piece, than to let a ray through between them
  bool found = false;
  float nearest = maximum;
  for (const double at : {root / qa, qc / root}) {  // one may be infinite or NaN: then all tests fail
    if (!(at >= -slack && at <= 1 + slack)) continue;
    const Double3 a = a0 + at * da, e = e0 + at * de, n = cross(d, e);
    const double nn = dot(n, n), beside = dot(cross(a, d), n) / nn;
    if (!(beside >= 0 && beside <= 1)) continue;
    const float there = float(start + dot(cross(a, e), n) / nn);
    if (!(there > 0 && there < nearest)) continue;
    nearest = there;
    u = float(std::clamp(at, 0.0, 1.0));
    v = float(beside);
    found = true;
  }
  t = nearest;
  return found;
}

void RibbonPiece::point(float u, float v, LocalPoint& p) const {
  const double x = double(u), y = double(v);
  const Double3 du = along(y), dv = across(x);
  Double3 side = (1 - x) * side0_ + x * side1_;
  if (!(dot(side, side) > 0)) side = Double3(to_.across);  // at a tip without width
  const Double3 n = normalize(cross(du, side));
  p.position = Point3{} + Vector3(p_ + x * axis_ + (y - 0.5) * dv);
  p.normal = Normal3(Vector3(n));
  p.uv = {lerp(u, from_.u, to_.u), v};
  p.dpdu = Vector3((1 / double(to_.u - from_.u)) * du);
  p.dpdv = Vector3(dv);
  p.u = u;
  p.v = v;
  // Rounding of the position in any direction, since it may fall into the next piece, and of the offset ray origin.
  p.error = rounding_bound(3) * (length(p.position - Point3{}) + from_.radius + to_.radius);
}

Bounds3 RibbonPiece::bounds() const {
  Bounds3 box;
  for (const CurveVertex* vertex : {&from_, &to_})
    for (const float side : {-1.0f, 1.0f}) box.add(vertex->position + (side * vertex->radius) * vertex->across);
  const float size = max_component(abs(box.centre() - Point3{})) + max_component(box.diagonal());
  const Vector3 margin = rounding_bound(8) * Vector3{size, size, size};
  return {box.low - margin, box.high + margin};
}

double RibbonPiece::area(int points) const {
  const double spread = points == 2 ? std::sqrt(1 / 3.0) : std::sqrt(0.6);
  double sum = 0;
  for (int i = 0; i < points; ++i)
    for (int k = 0; k < points; ++k) {
      const auto weight = [&](int j) { return points == 2 ? 0.5 : (j == 1 ? 4 / 9.0 : 2.5 / 9); };
      const auto place = [&](int j) { return 0.5 + 0.5 * spread * (points == 2 ? 2 * j - 1 : j - 1); };
      sum += weight(i) * weight(k) * stretch(place(i), place(k));
    }
  return sum;
}

Point2 RibbonPiece::sample(Point2 u) const {
  const double r0 = double(from_.radius), r1 = double(to_.radius), x = double(u.x);
  const double along = x * (r0 + r1) / (r0 + std::sqrt((1 - x) * r0 * r0 + x * r1 * r1));
  return {float(std::clamp(along, 0.0, 1.0)), u.y};
}

double RibbonPiece::pdf(float u, float v) const {
  const double x = double(u), r0 = double(from_.radius), r1 = double(to_.radius);
  const double width = 2 * ((1 - x) * r0 + x * r1) / (r0 + r1), s = stretch(x, double(v));
  return s > 0 ? width / s : 0;
}

size_t append_ribbon(std::span<const StrandPoint> points, std::vector<CurveVertex>& vertices) {
  const size_t n = points.size();
  for (size_t i = 0; i < n; ++i) {
    const Double3 before(points[i > 0 ? i - 1 : 0].position), here(points[i].position),
        after(points[std::min(i + 1, n - 1)].position);
    // The width is perpendicular to the mean direction of both adjacent pieces; where the strand reverses, to one piece.
    Double3 along;
    if (i > 0) along = normalize(here - before);
    if (i + 1 < n) along = along + normalize(after - here);
    if (!(length(along) > 1e-3)) along = normalize(here - before);
    const Double3 normal(points[i].normal), side = cross(normal, along);
    if (!(length(side) > 1e-3 * length(normal) * length(along))) return i;
    CurveVertex v;
    v.position = {float(here.x), float(here.y), float(here.z)};
    v.radius = float(points[i].radius);
    v.across = Vector3(normalize(side));
    v.u = float(points[i].u);
    vertices.push_back(v);
  }
  return n;
}

}  // namespace etendue
