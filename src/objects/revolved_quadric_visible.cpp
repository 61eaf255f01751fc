// Points of a closed surface of revolution that face a place outside.
//
// By the area of what faces it, times the weight: a point of the side at height z and azimuth phi has the outward normal
// (r cos phi, r sin phi, -f'(z)/2), and faces a place at distance rho from the axis, height h and azimuth phi0 when
//   cos(phi - phi0) > (r^2 + f'(z)/2 (h - z)) / (r rho):
// an arc of each ring. On cylinders and cones the arcs of all rings are the same; on others a height is chosen by the part
// of its ring that faces, which is a smooth function of the area below and known at a few of its values.

#include "revolved_quadric.h"

namespace etendue {

double RevolvedQuadric::half_width(const Facing& f, double z) const {
  const double r2 = profile_.squared_radius(z), plane = r2 + profile_.half_slope(z) * (f.height - z);
  const double reach = std::sqrt(r2) * f.around;
  if (plane >= reach) return 0;
  return plane <= -reach ? M_PI : std::acos(plane / reach);
}

double RevolvedQuadric::Facing::weight(double share) const {
  const double x = std::clamp(share, 0.0, 1.0) * pieces;
  const int k = std::min(int(x), pieces - 1);
  return weights[k] + (x - k) * (weights[k + 1] - weights[k]);
}

double RevolvedQuadric::Facing::share_at(double weight_share) const {
  double sum = 0;
  for (int k = 0; k < pieces; ++k) sum += weights[k] + weights[k + 1];
  double rest = weight_share * sum;
  int k = 0;
  while (k < pieces - 1 && rest >= weights[k] + weights[k + 1]) {
    rest -= weights[k] + weights[k + 1];
    ++k;
  }
  // (a + b) q is reached in a piece where a density that goes from a to b has the share q below it.
  const double a = weights[k], b = weights[k + 1], q = rest / (a + b);
  const double x = rest / (a + std::sqrt(a * a + q * (b * b - a * a)));
  return (k + std::clamp(x, 0.0, 1.0)) / pieces;
}

bool RevolvedQuadric::facing(const Point3& own, Facing& f) const {
  if (!closed()) return false;
  const double x = double(own.x), y = double(own.y);
  f.height = double(own.z);
  f.around = std::sqrt(x * x + y * y);
  const bool above = f.height > profile_.high, below = f.height < profile_.low;
  if (!above && !below && f.around * f.around < profile_.squared_radius(f.height)) return false;  // sees all from inside
  f.azimuth = std::atan2(y, x);
  if (below) f.low_area = low_area_;
  if (above) f.high_area = high_area_;
  if (profile_.developable) {
    // All rings alike: the widest tells.
    const double z = profile_.low_radius >= profile_.high_radius ? profile_.low : profile_.high;
    for (double& w : f.weights) w = half_width(f, z) / M_PI;
  } else {
    constexpr double least = 0.05;  // a ring that faces the place a little, between two that do not, must have a chance
    for (int k = 0; k <= Facing::pieces; ++k)
      f.weights[k] = std::max(least, half_width(f, height_at(double(k) / Facing::pieces)) / M_PI);
  }
  for (int k = 0; k < Facing::pieces; ++k) f.side_area += f.weights[k] + f.weights[k + 1];
  f.side_area *= side_area_ / (2 * Facing::pieces);
  f.area = f.low_area + f.side_area + f.high_area;
  return f.area > 0;
}

DirectionShare RevolvedQuadric::direction_share(const Point3& own, bool faced) const {
  const double z = double(own.z), off = z - 0.5 * (profile_.low + profile_.high), half = 0.5 * (profile_.high - profile_.low);
  const double r2 = double(own.x) * double(own.x) + double(own.y) * double(own.y);
  const double widest = std::max(profile_.low_radius, profile_.high_radius);
  const bool convex = closed() && profile_.convex;
  if (closed() && !faced) return {1, convex};
  return {r2 + off * off < widest * widest + half * half ? 0.5f : 0.0f, convex};
}

SurfaceSample RevolvedQuadric::sample_visible(const Point3& from, Point2 u, float time) const {
  Transform scratch;
  const Transform& t = placed(transform, time, scratch);
  const Point3 own_from = t.back(from);
  Facing f;
  const bool faced = facing(own_from, f);
  const auto sample = [&](Point2 v, SurfaceSample& s) {
    OwnPoint own;
    if (!(faced ? sample_facing(f, v, own) : own_sample(v, own) > 0)) return false;
    carry(own, time, s.point);
    return true;
  };
  const auto density = [&](const SurfacePoint& p) { return density_facing(faced ? &f : nullptr, from, t, p); };
  return sample_by_both(*this, direction_share(own_from, faced), from, u, time, sample, density);
}

float RevolvedQuadric::visible_density(const Point3& from, const Vector3& direction, const SurfacePoint& p) const {
  Transform scratch;
  const Transform& t = placed(transform, p.time, scratch);
  const Point3 own_from = t.back(from);
  Facing f;
  const bool faced = facing(own_from, f);
  const auto density = [&](const SurfacePoint& q) { return density_facing(faced ? &f : nullptr, from, t, q); };
  return density_by_both(direction_share(own_from, faced), from, direction, p, density);
}

bool RevolvedQuadric::sample_facing(const Facing& f, Point2 u, OwnPoint& own) const {
  const auto cap = [&](Part part, double radius, double share) {
    const double r = radius * std::sqrt(std::clamp(share, 0.0, 1.0)), phi = f.azimuth + 2 * M_PI * double(u.x);
    cap_point(part, r * std::cos(phi), r * std::sin(phi), own);
  };
  double y = double(u.y) * f.area;
  if (y < f.low_area) {
    cap(low_cap, profile_.low_radius, y / f.low_area);
    return true;
  }
  y -= f.low_area;
  if (y >= f.side_area && f.high_area > 0) {
    cap(high_cap, profile_.high_radius, 1 - (y - f.side_area) / f.high_area);
    return true;
  }
  if (!(f.side_area > 0)) return false;
  const double share = f.share_at(std::min(y / f.side_area, 1.0));
  const double z = std::clamp(height_at(share), profile_.low, profile_.high), r = std::sqrt(profile_.squared_radius(z));
  const double half = profile_.developable ? f.weights[0] * M_PI : half_width(f, z);
  const double phi = f.azimuth + half * (2 * double(u.x) - 1);
  side_point(r * std::cos(phi), r * std::sin(phi), z, own);
  return half > 0;
}

float RevolvedQuadric::density_facing(const Facing* f, const Point3& from, const Transform& t, const SurfacePoint& p) const {
  const float stretch = area_stretch(t, p.object_normal);
  if (!f) return 1 / (float(own_area()) * stretch);
  if (!(dot(p.normal, p.position - from) < 0)) return 0;
  double density = 1 / f->area;
  if (p.primitive == side) {
    if (!profile_.developable) {
      const double z = double(p.object_position.z), half = half_width(*f, z);
      density *= half > 0 ? f->weight(share_below(z)) * M_PI / half : 0;
    } else if (!(f->weights[0] > 0)) {
      return 0;
    }
  } else if (!(p.primitive == low_cap ? f->low_area > 0 : f->high_area > 0)) {
    return 0;
  }
  return float(density) / stretch;
}

}  // namespace etendue
