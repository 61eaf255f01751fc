#pragma once
// LensPupils: bounds of the exit pupils of film points, and a disc that all rays through the lens cross on the scene's side.

#include <vector>

#include "lens_system.h"

namespace etendue {

// Most rays from the film towards the rear of a lens are blocked by its stop or a rim. The rays that pass, from a point of the
// film at distance r from the axis, cross the plane of the rear vertex within a patch, the exit pupil, which is found by
// tracing rays for many values of r (Steinert et al. 2011; Pharr, Jakob & Humphreys, section 5.4.2 of the fourth edition). In
// front of the lens all rays that pass cross a disc, which is placed where it is smallest: near the entrance pupil.
class LensPupils {
 public:
  /// A rectangle that contains the exit pupil of film points on the +x axis; it is symmetric about the x axis.
  struct Box {
    double low = 0, high = 0, half_height = 0;
    double area() const { return (high - low) * 2 * half_height; }  ///< 0: no ray passes
  };

  /// Throws Error if no ray passes to the middle of the film.
  void find(const LensSystem&, double film_radius);

  /// A continuous function of the distance from the axis, so that a ray traced back from the scene finds the box through which
  /// it was sampled.
  Box box(double film_distance) const;
  /// The projected solid angle of the exit pupil, seen from the middle of the film [sr].
  double solid_angle() const { return solid_angle_; }
  double disc_z() const { return disc_z_; }
  double disc_radius() const { return disc_radius_; }

 private:
  void find_disc(const LensSystem&);

  double film_radius_ = 1, solid_angle_ = 0, disc_z_ = 0, disc_radius_ = 0;
  std::vector<Box> boxes_;  // at equal steps of r, each large enough for the values of r up to its neighbours
};

}  // namespace etendue
