#pragma once
// Samples directions from a point towards an object of revolution around the z axis, almost uniformly in solid angle.
//
// A direction is given by its azimuth psi around the line through the point parallel to z, counted from the direction to the
// axis, and by w, a function of the elevation such that solid angle is dpsi dw: w is the sine of the elevation, or for a point
// beyond an end of the object 1 minus the absolute value of the sine, which keeps its digits where the object is seen along its
// axis from afar. At one azimuth a half plane parallel to the axis cuts the object, and the object's visible part fills one or
// two intervals of w there, known exactly. An azimuth is sampled with a piecewise linear pdf over five nodes, proportional at
// the nodes to the total length of these intervals; w is uniform within the intervals. (Gamito 2016, "Solid angle sampling of
// disk and cylinder lights", samples a rectangle that covers a cylinder's side, and rejects directions that miss it; here few
// or no directions miss, and end discs and cones are covered too.)

#include <algorithm>
#include <cmath>

#include "geometry.h"

namespace etendue {

/// A pdf on [0, 1] that is linear between equally spaced nodes, given by its values at the nodes.
template <int pieces>
struct PiecewiseLinear {
  double nodes[pieces + 1]{};

  double mean() const {
    double sum = 0;
    for (int k = 0; k < pieces; ++k) sum += nodes[k] + nodes[k + 1];
    return sum / (2 * pieces);
  }
  /// The value at x, not normalized.
  double at(double x) const {
    x = std::clamp(x, 0.0, 1.0) * pieces;
    const int k = std::min(int(x), pieces - 1);
    return nodes[k] + (x - k) * (nodes[k + 1] - nodes[k]);
  }
  /// The inverse of the cumulative distribution function: the x below which the fraction `share` of the integral lies.
  double inverse(double share) const {
    double rest = share * 2 * pieces * mean();
    int k = 0;
    while (k < pieces - 1 && rest >= nodes[k] + nodes[k + 1]) {
      rest -= nodes[k] + nodes[k + 1];
      ++k;
    }
    // In a piece from a to b, the fraction q of its integral lies below x with a x + (b - a) x^2 / 2 = q (a + b) / 2.
    const double a = nodes[k], b = nodes[k + 1], q = rest / (a + b);
    const double x = rest / (a + std::sqrt(a * a + q * (b * b - a * a)));
    return (k + std::clamp(x, 0.0, 1.0)) / pieces;
  }
};

/// One or two intervals of w.
class Elevations {
 public:
  /// Adds an interval, with its ends in any order. After overlapping intervals are merged there may be at most two.
  void add(double a, double b) {
    if (a > b) std::swap(a, b);
    if (count_ == 1 && a <= high_[0] && b >= low_[0]) {
      low_[0] = std::min(low_[0], a);
      high_[0] = std::max(high_[0], b);
      return;
    }
    low_[count_] = a;
    high_[count_++] = b;
  }
  double extent() const { return (high_[0] - low_[0]) + (high_[1] - low_[1]); }
  /// Maps `share` in [0, 1] uniformly to the intervals.
  double at(double share) const {
    const double first = high_[0] - low_[0], x = share * extent();
    return x < first || count_ < 2 ? std::min(low_[0] + x, high_[0]) : std::min(low_[1] + (x - first), high_[1]);
  }

 private:
  double low_[2]{}, high_[2]{};
  int count_ = 0;
};

/// The point from which the object is seen, and the coordinates psi and w of directions at this point.
class AxialView {
 public:
  /// For an object of the given radius between the heights `low` and `high` [m].
  AxialView(const Point3& from, double low, double high, double radius)
      : x_(double(from.x)), y_(double(from.y)), height_(double(from.z)), low_(low), high_(high), radius_(radius) {
    around_ = std::sqrt(x_ * x_ + y_ * y_);
    side_ = height_ > high ? 1 : (height_ < low ? -1 : 0);
    greatest_ = around_ > radius ? std::asin(radius / around_) : M_PI;
    if (around_ > 0) inward_x_ = -x_ / around_, inward_y_ = -y_ / around_;
  }

  double around() const { return around_; }      ///< distance from the axis [m]
  double height() const { return height_; }      ///< [m]
  int side() const { return side_; }             ///< 1: above the object, -1: below, 0: between its heights
  double greatest() const { return greatest_; }  ///< the object lies within this azimuth to either side [rad]

  /// w of the direction to a point at the horizontal distance `distance` from the view point and at height z [m].
  double elevation(double distance, double z) const {
    const double rise = z - height_, l = std::sqrt(distance * distance + rise * rise);
    if (!(l > 0)) return 0;
    return side_ == 0 ? rise / l : distance * distance / (l * (l + std::abs(rise)));
  }
  /// w of the direction straight up (1) or down (-1). For a point beyond an end only the direction towards the object is
  /// queried; its w is 0.
  double pole(int sign) const { return side_ == 0 ? sign : 0; }

  /// Whether the segment to a point crosses the disc with the given radius at height z, a height between those of the two
  /// points.
  bool through(const Point3& to, double z, double radius) const {
    const double part = (z - height_) / (double(to.z) - height_);
    const double x = x_ + part * (double(to.x) - x_), y = y_ + part * (double(to.y) - y_);
    return x * x + y * y < radius * radius;
  }

  /// A ray in a direction that begins just before the object: over a long distance the rounding of a float direction would
  /// displace the ray too much.
  Ray ray(double azimuth, double w) const {
    const double cosine = std::sqrt(side_ == 0 ? (1 - w) * (1 + w) : w * (2 - w)), rise = side_ == 0 ? w : side_ * (w - 1);
    const double in = cosine * std::cos(azimuth), aside = cosine * std::sin(azimuth);
    const double d[3] = {in * inward_x_ - aside * inward_y_, in * inward_y_ + aside * inward_x_, rise};
    const double middle = 0.5 * (low_ + high_), half = 0.5 * (high_ - low_);
    const double way = (middle - height_) * d[2] - x_ * d[0] - y_ * d[1];
    const double skipped = std::max(0.0, way - 1.01 * std::sqrt(radius_ * radius_ + half * half));
    Ray r;
    r.origin = {float(x_ + skipped * d[0]), float(y_ + skipped * d[1]), float(height_ + skipped * d[2])};
    r.direction = {float(d[0]), float(d[1]), float(d[2])};
    return r;
  }

  /// Horizontal distances of a point from the view point: along (`in`) and across (`aside`) the direction to the axis.
  void locate(const Point3& to, double& in, double& aside) const {
    const double x = double(to.x) - x_, y = double(to.y) - y_;
    in = x * inward_x_ + y * inward_y_;
    aside = std::abs(y * inward_x_ - x * inward_y_);
  }
  double distance_to(const Point3& to) const {
    return std::hypot(double(to.x) - x_, double(to.y) - y_, double(to.z) - height_);
  }

 private:
  double x_, y_, height_, low_, high_, radius_;
  double inward_x_ = 1, inward_y_ = 0;  // the horizontal direction to the axis, unit
  double around_ = 0, greatest_ = 0;
  int side_ = 0;
};

/// The sampler of directions from a point in which an object is seen. `Seen` is the object as seen from this point:
///   AxialView view;
///   Elevations at(double sine, double cosine) const;   the visible intervals at an azimuth; symmetric
///   bool sees(const Point3& from, const Vector3& direction, const SurfacePoint&) const;   whether the point is visible
template <class Seen>
class AxialDirections {
 public:
  explicit AxialDirections(const Seen& seen) : seen_(seen), view_(seen.view) {
    double most = 0;
    for (int k = 0; k <= pieces; ++k) {
      const double psi = view_.greatest() * k / pieces;
      most = std::max(most, azimuths_.nodes[k] = seen.at(std::sin(psi), std::cos(psi)).extent());
    }
    // The intervals may vanish at one of the five nodes but not beside it, so the pdf at a node is at least a tenth of the
    // largest.
    for (double& node : azimuths_.nodes) node = std::max(node, 0.1 * most);
    scale_ = most > 0 ? 1 / (2 * view_.greatest() * azimuths_.mean()) : 0;
  }

  /// Samples a direction and returns the point that a ray in this direction hits.
  SurfaceSample sample(const SceneObject& object, const Transform& t, const Point3& from, Point2 u, float time) const {
    SurfaceSample s;
    const double x = 2 * double(u.x) - 1;
    const double psi = std::copysign(view_.greatest() * azimuths_.inverse(std::abs(x)), x);
    const Elevations there = seen_.at(std::sin(psi), std::cos(psi));
    if (!(scale_ > 0 && there.extent() > 0)) return s;
    Ray ray = view_.ray(psi, there.at(double(u.y)));
    if (!t.identity()) {
      ray.origin = t(ray.origin);
      ray.direction = normalize(t(ray.direction));
    }
    ray.time = time;
    Hit hit;
    if (!object.intersect(ray, hit)) return s;
    object.surface_point(ray, hit, s.point);
    complete_by_angle(s, from, 1);
    s.pdf *= pdf(t, from, s.direction, s.point);
    return s;
  }

  /// [1/sr]. A linear map M of directions v -> M v / |M v| enlarges solid angles by |det M| / |M v|^3, and |M v| is the
  /// distance in world space divided by the distance in object space.
  float pdf(const Transform& t, const Point3& from, const Vector3& direction, const SurfacePoint& p) const {
    if (!seen_.sees(from, direction, p)) return 0;
    const double inside = own_pdf(p.object_position);
    if (t.identity()) return float(inside);
    const double stretch = double(distance(p.position, from)) / view_.distance_to(p.object_position);
    return float(inside * stretch * stretch * stretch / double(std::abs(t.determinant())));
  }

 private:
  static constexpr int pieces = 4;

  /// The pdf in object space [1/sr].
  double own_pdf(const Point3& to) const {
    double in = 0, aside = 0;
    view_.locate(to, in, aside);
    const double s = std::sqrt(in * in + aside * aside),
                 extent = (s > 0 ? seen_.at(aside / s, in / s) : seen_.at(0, 1)).extent();
    return extent > 0 ? scale_ * azimuths_.at(std::atan2(aside, in) / view_.greatest()) / extent : 0;
  }

  const Seen& seen_;
  const AxialView& view_;
  PiecewiseLinear<pieces> azimuths_;
  double scale_ = 0;
};

}  // namespace etendue
