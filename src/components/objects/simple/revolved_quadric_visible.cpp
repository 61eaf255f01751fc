// Sampling of surfaces of revolution by solid angle from a reference point; see axial_view.h.
//
// At one azimuth a closed solid is visible between the lowest and the highest of these directions: to the points where the half
// plane of the azimuth, parallel to the axis, cuts the rims; tangent to the curve in which the half plane cuts the side; and
// straight up or down, if the line through the reference point parallel to the axis hits the solid. At a hyperboloid's waist
// this interval is too large, and directions that miss the solid are rejected.
//
// Surfaces other than closed solids and tubes without caps are sampled by area, and from nearby partly by direction.

#include "geometry/axial_view.h"
#include "revolved_quadric.h"

namespace etendue {
namespace {

struct Span {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void include(double w) {
    low = std::min(low, w);
    high = std::max(high, w);
  }
};

}  // namespace

/// The object as seen from a point, for AxialDirections.
struct RevolvedQuadric::Seen {
  const Profile& profile;
  AxialView view;
  bool tube;  ///< open at both ends
  bool usable;

  Seen(const RevolvedQuadric& object, const Point3& own)
      : profile(object.profile_),
        view(own, profile.low, profile.high, std::max(profile.low_radius, profile.high_radius)),
        tube(object.sector_.full() && profile.tube && !profile.low_cap && !profile.high_cap) {
    const bool inside = view.side() == 0 && view.around() * view.around() < profile.squared_radius(view.height());
    usable = tube || (object.closed() && !inside);
  }

  Elevations at(double sine, double cosine) const { return tube ? open_tube(sine, cosine) : solid(sine, cosine); }

  bool sees(const Point3& from, const Vector3& direction, const SurfacePoint& p) const {
    const bool front = dot(p.normal, direction) < 0;
    if (!tube) return front && (profile.convex || met_first(from, direction, p));
    // The inner wall is visible from inside, or through the nearer end.
    const double r = profile.low_radius;
    return front || view.around() < r ||
           (view.side() != 0 && view.through(p.object_position, view.side() > 0 ? profile.high : profile.low, r));
  }

  Elevations open_tube(double sine, double cosine) const;
  Elevations solid(double sine, double cosine) const;
};

Elevations RevolvedQuadric::Seen::open_tube(double sine, double cosine) const {
  const double r = profile.low_radius, across = view.around() * sine;
  const double far = view.around() * cosine + std::sqrt(std::max(0.0, r * r - across * across));
  const double near = (view.around() - r) * (view.around() + r) / far;
  Elevations seen;
  if (near > 0) seen.add(view.elevation(near, profile.low), view.elevation(near, profile.high));
  seen.add(view.elevation(far, profile.low), view.elevation(far, profile.high));
  return seen;
}

Elevations RevolvedQuadric::Seen::solid(double sine, double cosine) const {
  const double around = view.around(), h = view.height(), across = around * sine, toward = around * cosine;
  const double widest = std::max(profile.low_radius, profile.high_radius);
  Span seen;
  if (view.side() == 0) {
    if (around < profile.low_radius) seen.include(view.pole(-1));
    if (around < profile.high_radius) seen.include(view.pole(1));
  } else if (around < widest) {
    seen.include(view.pole(-view.side()));
  }
  const auto rim = [&](double r, double z) {
    double square = r * r - across * across;
    if (r == widest && toward > 0)
      square = std::max(square, 0.0);  // the root vanishes at the greatest azimuth; rounding may
                                       // make it negative
    if (square < 0) return;
    const double far = toward + std::sqrt(square);
    if (!(far > 0)) return;
    seen.include(view.elevation(far, z));
    const double near = (around - r) * (around + r) / far;
    if (near > 0) seen.include(view.elevation(near, z));
  };
  rim(profile.low_radius, profile.low);
  rim(profile.high_radius, profile.high);
  // A line z = h + m s, with s the horizontal distance from the reference point, intersects x^2 + y^2 = f(z) where
  //   (1 - a m^2) s^2 - 2 (toward + g m) s + c = 0,   a = f''/2,  g = f'(h)/2,  c = around^2 - f(h),
  // and is tangent to it where this has a double root, s = (toward + g m) / (1 - a m^2):
  //   (g^2 + a c) m^2 + 2 toward g m + toward^2 - c = 0.
  const double a = profile.square, g = profile.half_slope(h);
  if (a != 0 || g != 0) {
    const double c = around * around - ((a * h + profile.linear) * h + profile.constant);
    const double discriminant = c * (g * g + a * (c - toward * toward));
    if (discriminant >= 0) {
      const double q = -(toward * g + std::copysign(std::sqrt(discriminant), toward * g));
      const double slack = 1e-6 * (profile.high - profile.low);
      for (const double m : {q / (g * g + a * c), (toward * toward - c) / q}) {
        const double s = (toward + g * m) / (1 - a * m * m), z = h + m * s;
        if (s > 0 && z > profile.low - slack && z < profile.high + slack)
          seen.include(view.elevation(s, std::clamp(z, profile.low, profile.high)));
      }
    }
  }
  Elevations whole;
  if (seen.low < seen.high) whole.add(seen.low, seen.high);
  return whole;
}

DirectionShare RevolvedQuadric::direction_share(const Point3& own) const {
  if (closed()) return {1, profile_.convex};  // the point is inside
  const double z = double(own.z), off = z - 0.5 * (profile_.low + profile_.high), half = 0.5 * (profile_.high - profile_.low);
  const double r2 = double(own.x) * double(own.x) + double(own.y) * double(own.y);
  const double widest = std::max(profile_.low_radius, profile_.high_radius);
  return {r2 + off * off < widest * widest + half * half ? 0.5f : 0.0f, false};
}

SurfaceSample RevolvedQuadric::sample_visible(const Point3& from, Point2 u, float time) const {
  Transform scratch;
  const Transform& t = placed(transform, time, scratch);
  const Point3 own_from = t.back(from);
  const Seen seen(*this, own_from);
  if (seen.usable) return AxialDirections(seen).sample(*this, t, from, u, time);
  const auto sample = [&](Point2 v, SurfaceSample& s) {
    LocalPoint own;
    if (!(local_sample(v, own) > 0)) return false;
    carry(own, time, s.point);
    return true;
  };
  return sample_by_both(*this, direction_share(own_from), from, u, time, sample,
                        [this](const SurfacePoint& p) { return area_pdf(p); });
}

float RevolvedQuadric::visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const {
  Transform scratch;
  const Transform& t = placed(transform, p.time, scratch);
  const Point3 own_from = t.back(from);
  const Seen seen(*this, own_from);
  if (seen.usable) return AxialDirections(seen).pdf(t, from, direction, p);
  return pdf_by_both(direction_share(own_from), from, direction, p, [this](const SurfacePoint& q) { return area_pdf(q); });
}

}  // namespace etendue
