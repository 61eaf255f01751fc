#pragma once
// Intersections of a ray with quadrics and slabs, as intervals of the ray parameter, so that entries into and exits from a
// solid pair up.

#include "etendue/placed_object.h"
#include "geometry.h"

namespace etendue {

/// The part of a line on which a t^2 + 2 b t + c <= 0: from `low` to `high`, or if `beyond` is set, the rest of the line
/// outside that interval. The empty set has low > high.
struct QuadricInside {
  double low = 1, high = -1;
  bool beyond = false;
};

/// q = -(b + sign(b) sqrt(b^2 - a c)) has no cancellation; the roots are q / a and c / q (Hearn & Baker 2004). If a is zero,
/// one root is infinite, as it should be.
inline QuadricInside quadric_inside(double a, double b, double c) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return a < 0 ? QuadricInside{-endless, endless} : QuadricInside{};
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  if (q == 0) {  // b = 0 and a c = 0
    if (a == 0) return c <= 0 ? QuadricInside{-endless, endless} : QuadricInside{};
    return a < 0 ? QuadricInside{-endless, endless} : QuadricInside{0, 0};
  }
  const double other = c / q;
  if (a == 0) return q < 0 ? QuadricInside{-endless, other} : QuadricInside{other, endless};
  const double one = q / a;
  return {std::min(one, other), std::max(one, other), a < 0};
}

/// A ray re-parametrized to start at its point nearest to a given point on the z axis. From a far origin the coefficients of a
/// quadric would be differences of huge numbers.
struct NearRay {
  double x, y, z, dx, dy, dz;
  double start;  ///< the original ray's parameter at the new start

  NearRay(const Ray& ray, double height)
      : dx(double(ray.direction.x)), dy(double(ray.direction.y)), dz(double(ray.direction.z)) {
    const double ox = double(ray.origin.x), oy = double(ray.origin.y), oz = double(ray.origin.z);
    start = -(ox * dx + oy * dy + (oz - height) * dz) / (dx * dx + dy * dy + dz * dz);
    x = ox + start * dx;
    y = oy + start * dy;
    z = oz + start * dz;
  }

  /// The part of the ray where x^2 + y^2 <= square z^2 + linear z + constant.
  QuadricInside inside(double square, double linear, double constant) const {
    const double axial = square * dz;
    return quadric_inside(dx * dx + dy * dy - axial * dz, x * dx + y * dy - axial * z - 0.5 * linear * dz,
                          x * x + y * y - ((square * z + linear) * z + constant));
  }
};

/// The part of a ray between two planes of constant z; empty unless `enter` < `leave`.
struct SlabInside {
  double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
  bool upwards = true;  ///< enters through the low plane

  SlabInside(const NearRay& ray, double low, double high) : upwards(ray.dz > 0) {
    if (ray.dz == 0) {
      if (ray.z < low || ray.z > high) leave = enter;
      return;
    }
    enter = ((upwards ? low : high) - ray.z) / ray.dz;
    leave = ((upwards ? high : low) - ray.z) / ray.dz;
  }
};

/// Stores a crossing t in a hit. The rounding error of the float distance is stored in Hit::u, so that the hit point keeps
/// double precision: the rounded t alone would displace points of a small object that is hit from far away.
inline bool take_hit(const Ray& ray, double t, std::uint32_t part, Hit& hit) {
  const float rounded = float(t);
  if (!(rounded > 0 && rounded < ray.maximum)) return false;
  hit.distance = rounded;
  hit.primitive = part;
  hit.u = float(t - double(rounded));
  hit.v = 0;
  return true;
}
inline double exact_distance(const Hit& hit) { return double(hit.distance) + double(hit.u); }

/// Fills a point of a flat face of constant z, with Cartesian surface coordinates over the square around a disc of the given
/// radius, as Disc has them. u is reversed on a face that faces down, so that dpdu x dpdv points to the front.
inline void flat_point(double x, double y, double z, double radius, bool up, double extent, LocalPoint& p) {
  const float r = float(radius), side = up ? 1.0f : -1.0f;
  p.position = {float(x), float(y), float(z)};
  p.normal = {0, 0, side};
  p.uv = {clamp(0.5f * (1 + side * p.position.x / r), 0, 1), clamp(0.5f * (1 + p.position.y / r), 0, 1)};
  p.dpdu = {2 * side * r, 0, 0};
  p.dpdv = {0, 2 * r, 0};
  p.error = rounding_bound(3) * (std::abs(p.position.z) + float(extent));
}

/// The sector of a full turn around z that an object covers, from the x axis counter-clockwise.
class Sector {
 public:
  explicit Sector(double angle = 2 * M_PI)
      : angle_(angle), full_(angle > 2 * M_PI * (1 - 1e-7)), cosine_(std::cos(angle)), sine_(std::sin(angle)) {
    if (full_) angle_ = 2 * M_PI;
  }
  double angle() const { return angle_; }  ///< [rad]
  bool full() const { return full_; }
  double share() const { return angle_ / (2 * M_PI); }

  bool holds(double x, double y) const {
    if (full_) return true;
    const bool after_start = y >= 0, before_end = x * sine_ - y * cosine_ >= 0;
    return angle_ <= M_PI ? after_start && before_end : after_start || before_end;
  }
  /// The azimuth divided by the sector's angle, in [0, 1].
  float part(double x, double y) const {
    const float phi = positive_atan2(float(y), float(x));
    if (full_) return std::min(phi / (2 * pi), 1.0f);
    if (phi <= float(angle_)) return phi / float(angle_);
    return phi < float(0.5 * angle_ + M_PI) ? 1.0f : 0.0f;  // just outside the sector by rounding
  }

 private:
  double angle_;
  bool full_;
  double cosine_, sine_;
};

}  // namespace etendue
