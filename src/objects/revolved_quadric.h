#pragma once
// What cylinders, cones, paraboloids and hyperboloids share.

#include "quadric_roots.h"
#include "visible_directions.h"

namespace etendue {

/// The side x^2 + y^2 = f(z), f of at most second degree, between two heights, with discs as caps or without. A solid is the
/// part of a slab that lies inside the quadric: a ray crosses it where an interval in both begins and ends, always in pairs.
class RevolvedQuadric : public PlacedObject {
 public:
  bool closed() const override {
    return sector_.full() && (profile_.low_cap || profile_.low_radius == 0) && (profile_.high_cap || profile_.high_radius == 0);
  }
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override;
  float visible_density(const Point3& from, const Vector3& direction, const SurfacePoint&) const override;

  float sweep = 360;  ///< how much of a turn there is [deg]

 protected:
  struct Profile {
    double square = 0, linear = 0, constant = 1;  ///< of f(z)
    double low = 0, high = 1;                     ///< heights [m]
    double low_radius = 1, high_radius = 1;       ///< [m]
    bool low_cap = false, high_cap = false;
    double side_area = 1;      ///< of a whole turn [m^2]
    bool developable = false;  ///< a cylinder or a cone: one plane touches it all along a straight line
    bool convex = true;

    double squared_radius(double z) const { return std::max(0.0, (square * z + linear) * z + constant); }
    double half_slope(double z) const { return square * z + 0.5 * linear; }  ///< f'(z) / 2 = r r'
  };
  /// To be called at the end of prepare.
  void revolve(const Profile&);
  const Profile& profile() const { return profile_; }

  /// The height below which a share of the side's area lies, and its inverse.
  virtual double height_at(double share) const = 0;
  virtual double share_below(double z) const = 0;

  /// The coordinate v along the profile, from 0 to 1, and the changes of height and radius with it.
  struct Along {
    double v, height_rate, radius_rate;
  };
  /// By default v goes with the height.
  virtual Along along_profile(double z, double r) const;

  Bounds3 own_bounds() const override;
  bool own_intersect(const Ray&, Hit&) const override;
  void own_point(const Ray&, const Hit&, OwnPoint&) const override;
  double own_area() const override { return low_area_ + side_area_ + high_area_; }
  float own_sample(Point2 u, OwnPoint&) const override;

 private:
  enum Part : std::uint32_t { side, low_cap, high_cap };

  /// What of a closed surface faces a point outside of it.
  struct Facing {
    static constexpr int pieces = 8;
    double around = 0, height = 0, azimuth = 0;         ///< of the point, in own coordinates [m], [rad]
    double low_area = 0, side_area = 0, high_area = 0;  ///< of the parts, the side by its weights [m^2]
    double area = 0;                                    ///< their sum
    double weights[pieces + 1]{};  ///< at equal shares of the side's area: roughly what part of the turn faces the point
    /// Interpolated.
    double weight(double share) const;
    /// Where a share of the side's weight is reached.
    double share_at(double weight_share) const;
  };
  bool facing(const Point3& own, Facing&) const;
  /// Half the angle around the axis in which points of a height face the point [rad].
  double half_width(const Facing&, double z) const;

  /// By area, of what faces the point; false: none was found. And its density [1/m^2]; without Facing, that by the whole area.
  bool sample_facing(const Facing&, Point2 u, OwnPoint&) const;
  float density_facing(const Facing*, const Point3& from, const Transform&, const SurfacePoint&) const;
  /// From inside always by direction, from close by half of the time.
  DirectionShare direction_share(const Point3& own, bool faced) const;

  void side_point(double x, double y, double z, OwnPoint&) const;
  void cap_point(Part, double x, double y, OwnPoint&) const;

  Profile profile_;
  Sector sector_;
  double low_area_ = 0, side_area_ = 0, high_area_ = 0;
  double extent_ = 1;  // the smaller of width and height: the size of errors in double, in floats
};

}  // namespace etendue
