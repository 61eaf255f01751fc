#include "placed_object.h"

namespace etendue {

void PlacedObject::place() {
  if (unbounded()) {
    bounds_ = endless_box();
    still_area_ = {infinity, 0};
    return;
  }
  const Bounds3 own = own_bounds();
  bounds_ = transform.animated() ? swept(transform, own) : transform.still()(own);
  // Rounding may move points out of the exact box.
  const Vector3 margin = rounding_bound(8) * (bounds_.diagonal() + abs(bounds_.centre() - Point3{}));
  bounds_.low = bounds_.low - margin;
  bounds_.high = bounds_.high + margin;
  // The margin covers the rounding of object-space and of world-space coordinates. |M^-T n| is the reciprocal of the factor by
  // which the transform widens slabs across n.
  const auto largest = [](const Bounds3& b) { return max_component(abs(b.centre() - Point3{}) + 0.5f * b.diagonal()); };
  float shrunk = 0;
  for (const Normal3& axis : {Normal3(1, 0, 0), Normal3(0, 1, 0), Normal3(0, 0, 1)})
    shrunk = std::max(shrunk, length(Vector3(transform.still()(axis))));
  margin_ = border * (largest(own) + largest(bounds_) * shrunk);
  still_area_ = area_of(transform.still());
}

bool PlacedObject::intersect(const Ray& ray, Hit& hit) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  if (!own_intersect(t.identity() ? ray : ray_into(t, ray), hit)) return false;
  hit.object = this;
  hit.depth = 0;
  return true;
}

bool PlacedObject::occludes(const Ray& ray) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  return own_occludes(t.identity() ? ray : ray_into(t, ray));
}

void PlacedObject::surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  carry(point_of(t.identity() ? ray : ray_into(t, ray), hit), ray.time, p);
}

OwnPoint PlacedObject::point_of(const Ray& ray, const Hit& hit) const {
  OwnPoint own;
  own.primitive = hit.primitive;
  own.u = hit.u;
  own.v = hit.v;
  own_point(ray, hit, own);
  return own;
}

void PlacedObject::carry(const OwnPoint& own, float time, SurfacePoint& p) const {
  p.position = own.position;
  p.object_position = own_place(transform, own.position);
  p.normal = p.object_normal = own.normal;
  p.shading_normal = own.shading_normal == Normal3{} ? own.normal : own.shading_normal;
  p.error = own.error;
  p.uv = own.uv;
  p.dpdu = own.dpdu;
  p.dpdv = own.dpdv;
  p.time = time;
  p.object = this;
  p.primitive = own.primitive;
  p.u = own.u;
  p.v = own.v;
  Transform scratch;
  const Transform& t = placed(transform, time, scratch);
  if (!t.identity()) carry_out(t, p);
}

void PlacedObject::tangents(SurfacePoint& p) const {
  if (p.dpdu != Vector3{} || p.dpdv != Vector3{}) return;
  Ray ray;  // all its points are its origin
  ray.origin = Point3(DoublePoint3(p.object_position) - (transform.inner() - DoublePoint3{}));
  ray.direction = {};
  Hit hit;
  hit.distance = 0;
  hit.primitive = p.primitive;
  hit.u = p.u;
  hit.v = p.v;
  const OwnPoint own = point_of(ray, hit);
  Transform scratch;
  const Transform& t = placed(transform, p.time, scratch);
  p.dpdu = t(own.dpdu);
  p.dpdv = t(own.dpdv);
}

float PlacedObject::area(float time) const {
  return transform.animated() && !unbounded() ? area_of(transform.at(time)).value : still_area_.value;
}

float PlacedObject::area_error(float time) const {
  return transform.animated() && !unbounded() ? area_of(transform.at(time)).error : still_area_.error;
}

SurfaceSample PlacedObject::sample_area(Point2 u, float time) const {
  SurfaceSample s;
  OwnPoint own;
  const float pdf = own_sample(u, own);
  if (!(pdf > 0)) return s;
  carry(own, time, s.point);
  Transform scratch;
  const Transform& t = placed(transform, time, scratch);
  s.pdf = t.identity() ? pdf : pdf / area_stretch(t, own.normal);
  return s;
}

float PlacedObject::area_pdf(const SurfacePoint& p) const {
  Transform scratch;
  const Transform& t = placed(transform, p.time, scratch);
  const float pdf = own_pdf(p);
  return t.identity() ? pdf : pdf / area_stretch(t, p.object_normal);
}

PlacedObject::Area PlacedObject::area_of(const Transform& t) const {
  const double own = own_area();
  if (const float s = similarity_scale(t); s > 0) return {float(own * double(s) * double(s)), own_area_error()};
  // Integrates the stretch factor over the object-space area, piece by piece in the coordinates of own_sample: between the
  // seams, stretch and map are smooth, so Gauss-Legendre quadrature converges fast.
  const Seams seams = own_seams();
  double sum = 0, off = 0;
  for (size_t i = 0; i <= seams.x.size(); ++i)
    for (size_t k = 0; k <= seams.y.size(); ++k) {
      const auto between = [](const std::vector<double>& list, size_t at) {
        return std::pair(at == 0 ? 0 : list[at - 1], at == list.size() ? 1 : list[at]);
      };
      const auto [x0, x1] = between(seams.x, i);
      const auto [y0, y1] = between(seams.y, k);
      if (!(x1 > x0 && y1 > y0)) continue;
      const Piece piece{x0, x1, y0, y1};
      double coarse = 0, fine = stretched(t, piece, 1);
      constexpr int most = 16;
      for (int panels = 2; panels <= most; panels *= 2) {
        coarse = fine;
        fine = stretched(t, piece, panels);
        if (std::abs(fine - coarse) <= 1e-7 * fine) break;
      }
      sum += fine;
      off += std::abs(fine - coarse);
    }
  return {float(sum), sum > 0 ? own_area_error() + float(off / sum) : 0};
}

double PlacedObject::stretched(const Transform& t, const Piece& piece, int panels) const {
  // Gauss-Legendre quadrature with six points (Abramowitz & Stegun 1964, table 25.4), here for [0, 1].
  constexpr double half[] = {0.2386191860831969 / 2, 0.6612093864662645 / 2, 0.9324695142031521 / 2};
  constexpr double weights[] = {0.4679139345726910 / 2, 0.3607615730481386 / 2, 0.1713244923791704 / 2};
  constexpr int points = 6;
  const auto place = [&](int i) { return (i / points + 0.5 + (i % 2 ? 1 : -1) * half[i % points / 2]) / panels; };
  double sum = 0;
  for (int i = 0; i < panels * points; ++i)
    for (int k = 0; k < panels * points; ++k) {
      OwnPoint p;
      const float pdf =
          own_sample({float(std::lerp(piece.x0, piece.x1, place(i))), float(std::lerp(piece.y0, piece.y1, place(k)))}, p);
      if (pdf > 0) sum += weights[i % points / 2] * weights[k % points / 2] * double(area_stretch(t, p.normal)) / double(pdf);
    }
  return sum * (piece.x1 - piece.x0) * (piece.y1 - piece.y0) / (double(panels) * panels);
}

}  // namespace etendue
