#pragma once
// RevolvedQuadric: base class of cylinders, cones, paraboloids and hyperboloids.

#include "geometry/quadric_roots.h"
#include "geometry/visible_directions.h"

namespace etendue {

/// The side x^2 + y^2 = f(z), with f of at most second degree, between two heights, with or without discs as caps. The solid is
/// the part of a slab that lies inside the quadric: a ray's crossings are the ends of the intervals that lie in both, so they
/// come in pairs.
class RevolvedQuadric : public PlacedObject {
 public:
  bool closed() const override {
    return sector_.full() && (profile_.low_cap || profile_.low_radius == 0) && (profile_.high_cap || profile_.high_radius == 0);
  }
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override;
  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint&) const override;

  float sweep = 360;  ///< azimuth range of the surface [deg]

 protected:
  struct Profile {
    double square = 0, linear = 0, constant = 1;  ///< coefficients of f(z)
    double low = 0, high = 1;                     ///< heights [m]
    double low_radius = 1, high_radius = 1;       ///< [m]
    bool low_cap = false, high_cap = false;
    double side_area = 1;  ///< for a full turn [m^2]
    bool tube = false;     ///< a cylinder: the radius is constant
    bool convex = true;

    double squared_radius(double z) const { return std::max(0.0, (square * z + linear) * z + constant); }
    double half_slope(double z) const { return square * z + 0.5 * linear; }  ///< f'(z) / 2 = r r'
  };
  /// To be called at the end of prepare.
  void revolve(const Profile&);
  const Profile& profile() const { return profile_; }

  /// The height below which the fraction `share` of the side's area lies.
  virtual double height_at(double share) const = 0;

  /// The coordinate v along the profile, from 0 to 1, and the derivatives of height and radius by v.
  struct Along {
    double v, height_rate, radius_rate;
  };
  /// By default v is proportional to the height.
  virtual Along along_profile(double z, double r) const;

  Bounds3 local_bounds() const override;
  bool local_intersect(const Ray&, Hit&) const override;
  void local_point(const Ray&, const Hit&, LocalPoint&) const override;
  double local_area() const override { return low_area_ + side_area_ + high_area_; }
  float local_sample(Point2 u, LocalPoint&) const override;
  Seams local_seams() const override { return {{}, {low_area_ / local_area(), (low_area_ + side_area_) / local_area()}}; }

 private:
  enum Part : std::uint32_t { side, low_cap, high_cap };

  struct Seen;
  /// The share of samples by direction where AxialDirections is not used: all from inside, half of them from nearby.
  DirectionShare direction_share(const Point3& own) const;

  void side_point(double x, double y, double z, LocalPoint&) const;
  void cap_point(Part, double x, double y, LocalPoint&) const;

  Profile profile_;
  Sector sector_;
  double low_area_ = 0, side_area_ = 0, high_area_ = 0;
  double extent_ = 1;  // the smaller of radius and height: the scale of rounding errors in float
};

}  // namespace etendue
