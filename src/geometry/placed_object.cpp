#include "etendue/placed_object.h"

#include "geometry.h"

namespace etendue {

void PlacedObject::place() {
  if (unbounded()) {
    bounds_ = endless_box();
    still_area_ = {infinity, 0};
    return;
  }
  const Bounds3 local = local_bounds();
  bounds_ = bounds_of(transform, local);
  // The least distance of points from an edge (see `border`) covers the rounding of object-space and of world-space
  // coordinates. |M^-T n| is the reciprocal of the factor by which the transform widens slabs across n.
  const auto largest = [](const Bounds3& b) { return max_component(abs(b.centre() - Point3{}) + 0.5f * b.diagonal()); };
  float shrunk = 0;
  for (const Normal3& axis : {Normal3(1, 0, 0), Normal3(0, 1, 0), Normal3(0, 0, 1)})
    shrunk = std::max(shrunk, length(Vector3(transform.still()(axis))));
  margin_ = border * (largest(local) + largest(bounds_) * shrunk);
  still_area_ = area_of(transform.still());
}

bool PlacedObject::intersect(const Ray& ray, Hit& hit) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  if (!local_intersect(t.identity() ? ray : ray_into(t, ray), hit)) return false;
  hit.object = this;
  hit.depth = 0;
  return true;
}

bool PlacedObject::occludes(const Ray& ray) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  return local_occludes(t.identity() ? ray : ray_into(t, ray));
}

void PlacedObject::surface_point(const Ray& ray, const Hit& hit, SurfacePoint& p) const {
  Transform scratch;
  const Transform& t = placed(transform, ray.time, scratch);
  carry(point_of(t.identity() ? ray : ray_into(t, ray), hit), ray.time, p);
}

LocalPoint PlacedObject::point_of(const Ray& ray, const Hit& hit) const {
  LocalPoint local;
  local.primitive = hit.primitive;
  local.u = hit.u;
  local.v = hit.v;
  local_point(ray, hit, local);
  return local;
}

void PlacedObject::carry(const LocalPoint& local, float time, SurfacePoint& p) const {
  p.position = local.position;
  p.object_position = object_position_of(transform, local.position);
  p.normal = p.object_normal = local.normal;
  p.shading_normal = local.shading_normal == Normal3{} ? local.normal : local.shading_normal;
  p.error = local.error;
  p.uv = local.uv;
  p.dpdu = local.dpdu;
  p.dpdv = local.dpdv;
  p.time = time;
  p.object = this;
  p.primitive = local.primitive;
  p.u = local.u;
  p.v = local.v;
  Transform scratch;
  const Transform& t = placed(transform, time, scratch);
  if (!t.identity()) carry_out(t, p);
}

void PlacedObject::tangents(SurfacePoint& p) const {
  if (p.dpdu != Vector3{} || p.dpdv != Vector3{}) return;
  Ray ray;  // all its points are its origin
  ray.origin = Point3(DoublePoint3(p.object_position) - (transform.inner_origin() - DoublePoint3{}));
  ray.direction = {};
  Hit hit;
  hit.distance = 0;
  hit.primitive = p.primitive;
  hit.u = p.u;
  hit.v = p.v;
  const LocalPoint own = point_of(ray, hit);
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
  LocalPoint local;
  const float pdf = local_sample(u, local);
  if (!(pdf > 0)) return s;
  carry(local, time, s.point);
  Transform scratch;
  const Transform& t = placed(transform, time, scratch);
  s.pdf = t.identity() ? pdf : pdf / t.area_stretch(local.normal);
  return s;
}

float PlacedObject::area_pdf(const SurfacePoint& p) const {
  Transform scratch;
  const Transform& t = placed(transform, p.time, scratch);
  const float pdf = local_pdf(p);
  return t.identity() ? pdf : pdf / t.area_stretch(p.object_normal);
}

PlacedObject::Area PlacedObject::area_of(const Transform& t) const {
  const double own = local_area();
  if (const float s = similarity_scale(t); s > 0) return {float(own * double(s) * double(s)), local_area_error()};
  // Integrates the stretch factor over the object-space area, piece by piece in the coordinates of local_sample: between the
  // seams, stretch and map are smooth, so Gauss-Legendre quadrature converges fast.
  const Seams seams = local_seams();
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
  return {float(sum), sum > 0 ? local_area_error() + float(off / sum) : 0};
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
      LocalPoint p;
      const float pdf =
          local_sample({float(std::lerp(piece.x0, piece.x1, place(i))), float(std::lerp(piece.y0, piece.y1, place(k)))}, p);
      if (pdf > 0) sum += weights[i % points / 2] * weights[k % points / 2] * double(t.area_stretch(p.normal)) / double(pdf);
    }
  return sum * (piece.x1 - piece.x0) * (piece.y1 - piece.y0) / (double(panels) * panels);
}

}  // namespace etendue
