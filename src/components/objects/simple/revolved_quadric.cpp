#include "revolved_quadric.h"

#include "geometry/double_ray.h"

namespace etendue {

void RevolvedQuadric::revolve(const Profile& profile) {
  profile_ = profile;
  if (!(sweep > 0 && sweep <= 360)) fail("sweep", "must be above 0 and at most 360 deg");
  sector_ = Sector(double(sweep) * (M_PI / 180));
  const double part = sector_.share();
  low_area_ = profile.low_cap ? part * M_PI * profile.low_radius * profile.low_radius : 0;
  high_area_ = profile.high_cap ? part * M_PI * profile.high_radius * profile.high_radius : 0;
  side_area_ = part * profile.side_area;
  if (!(float(local_area()) > 0 && float(local_area()) < infinity))
    fail("height", "the surface is too small or too large: its area is no float");
  extent_ = std::min(std::max(profile.low_radius, profile.high_radius), profile.high - profile.low);
  place();
}

RevolvedQuadric::Along RevolvedQuadric::along_profile(double z, double r) const {
  const double height = profile_.high - profile_.low;
  return {(z - profile_.low) / height, height, r > 0 ? profile_.half_slope(z) / r * height : 0};
}

Bounds3 RevolvedQuadric::local_bounds() const {
  const float r = float(std::max(profile_.low_radius, profile_.high_radius));
  Bounds3 box;
  box.add(Point3{-r, -r, float(profile_.low)});
  box.add(Point3{r, r, float(profile_.high)});
  return box;
}

bool RevolvedQuadric::local_intersect(const Ray& ray, Hit& hit) const {
  const NearRay near(ray, 0.5 * (profile_.low + profile_.high));
  const SlabInside slab(near, profile_.low, profile_.high);
  if (!(slab.enter < slab.leave)) return false;
  const QuadricInside round = near.inside(profile_.square, profile_.linear, profile_.constant);
  if (round.low > round.high) return false;

  const auto take = [&](double t, Part part) {
    if (part == low_cap && !profile_.low_cap) return false;
    if (part == high_cap && !profile_.high_cap) return false;
    if (!sector_.full() && !sector_.holds(near.x + t * near.dx, near.y + t * near.dy)) return false;
    return take_hit(ray, near.start + t, part, hit);
  };
  const auto solid = [&](double low, double high) {
    const bool by_side = low > slab.enter, out_by_side = high < slab.leave;
    const double enter = by_side ? low : slab.enter, leave = out_by_side ? high : slab.leave;
    return enter < leave && (take(enter, by_side ? side : (slab.upwards ? low_cap : high_cap)) ||
                             take(leave, out_by_side ? side : (slab.upwards ? high_cap : low_cap)));
  };
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  if (!round.beyond) return solid(round.low, round.high);
  return solid(-unlimited, round.low) || solid(round.high, unlimited);
}

void RevolvedQuadric::local_point(const Ray& ray, const Hit& hit, LocalPoint& p) const {
  const DoubleRay r(ray);
  const double t = exact_distance(hit);
  double x = r.at(t, 0), y = r.at(t, 1), z = within(r.at(t, 2), profile_.low, profile_.high);
  if (hit.primitive == side) {
    // Newton's method projects the point onto the side: t may have the rounding error of a longer ray, if the object is an
    // operand of a solid.
    for (int i = 0; i < 2; ++i) {
      const double slope = profile_.half_slope(z), g2 = x * x + y * y + slope * slope;
      if (!(g2 > 0)) break;
      const double step = 0.5 * (x * x + y * y - profile_.squared_radius(z)) / g2;
      x -= step * x;
      y -= step * y;
      z = within(z + step * slope, profile_.low, profile_.high);
    }
    side_point(x, y, z, p);
  } else
    cap_point(Part(hit.primitive), x, y, p);
}

void RevolvedQuadric::side_point(double x, double y, double z, LocalPoint& p) const {
  // Half the gradient of x^2 + y^2 - f(z); at the tip of a cone it vanishes.
  const double r = std::sqrt(x * x + y * y), slope = profile_.half_slope(z), l = std::sqrt(r * r + slope * slope);
  const double up = 2 * z > profile_.low + profile_.high ? 1 : -1;
  p.position = {float(x), float(y), float(z)};
  p.normal = l > 0 ? Normal3(float(x / l), float(y / l), float(-slope / l)) : Normal3(0, 0, float(up));
  p.primitive = side;
  const Along rates = along_profile(z, r);
  p.uv = {sector_.part(x, y), clamp(float(rates.v), 0, 1)};
  const double angle = sector_.angle();
  if (r > 1e-7 * extent_) {
    const double out = rates.radius_rate / r;
    p.dpdu = {float(-angle * y), float(angle * x), 0};
    p.dpdv = {float(out * x), float(out * y), float(rates.height_rate)};
  } else {  // at a tip the direction of u is undefined: an arbitrary one perpendicular to the normal is used
    const Frame frame(p.normal);
    const float size = float(angle * extent_);
    p.dpdu = size * frame.s;
    p.dpdv = size * frame.t;
  }
  // One half is for the rounding of the position, one half for that of an offset ray origin.
  const Vector3 here{std::abs(p.position.x), std::abs(p.position.y), std::abs(p.position.z)};
  p.error = rounding_bound(3) * (etendue::along(p.normal, here) + float(extent_));
}

void RevolvedQuadric::cap_point(Part part, double x, double y, LocalPoint& p) const {
  const bool up = part == high_cap;
  const double rim = up ? profile_.high_radius : profile_.low_radius, r = std::sqrt(x * x + y * y);
  const double inward = r > 0 ? within(r, -rim, rim) / r : 1;
  flat_point(inward * x, inward * y, up ? profile_.high : profile_.low, rim, up, extent_, p);
  p.primitive = part;
}

float RevolvedQuadric::local_sample(Point2 u, LocalPoint& p) const {
  // u runs around the axis, and v from the centre of the low cap outwards, along the side and inwards on the high cap: a
  // continuous map.
  const double area = local_area(), y = double(u.y) * area, phi = sector_.angle() * double(u.x);
  const double cosine = std::cos(phi), sine = std::sin(phi);
  if (y < low_area_) {
    const double r = profile_.low_radius * std::sqrt(y / low_area_);
    cap_point(low_cap, r * cosine, r * sine, p);
  } else if (y < low_area_ + side_area_) {
    const double z = within(height_at((y - low_area_) / side_area_), profile_.low, profile_.high);
    const double r = std::sqrt(profile_.squared_radius(z));
    side_point(r * cosine, r * sine, z, p);
  } else {
    const double r = high_area_ > 0 ? profile_.high_radius * std::sqrt(std::max(0.0, (area - y) / high_area_)) : 0;
    if (high_area_ > 0)
      cap_point(high_cap, r * cosine, r * sine, p);
    else  // beyond the end of the side, by rounding
      side_point(profile_.high_radius * cosine, profile_.high_radius * sine, profile_.high, p);
  }
  return float(1 / area);
}

}  // namespace etendue
