#pragma once
// Where rays pass through a lens: what is aimed at from the film, and from the scene.

#include <vector>

#include "lens_system.h"

namespace etendue {

// Most rays towards the rear of a lens end at its stop or at a rim. Those that pass, from a point of the film at distance r
// from the axis, cross the plane of the rear vertex within a patch, the exit pupil, which is found by trying for as many r
// (Steinert et al. 2011; Pharr, Jakob & Humphreys, section 5.4.2 of the fourth edition). From outside all that pass cross a
// disc, which is put where it is smallest: near the entrance pupil.
class LensPupils {
 public:
  /// A rectangle that holds the pupil of film points on the +x axis; it is as far from the axis on both sides of it.
  struct Box {
    double low = 0, high = 0, half_height = 0;
    double area() const { return (high - low) * 2 * half_height; }  ///< 0: nothing passes
  };

  /// Throws Error when nothing passes to the middle of the film.
  void find(const LensSystem&, double film_radius);

  /// It changes steadily: a ray that comes back finds the one it was sent through.
  Box box(double film_distance) const;
  /// The projected solid angle of all that passes to the middle of the film [sr].
  double solid_angle() const { return solid_angle_; }
  double disc_z() const { return disc_z_; }
  double disc_radius() const { return disc_radius_; }

 private:
  void find_disc(const LensSystem&);

  double film_radius_ = 1, solid_angle_ = 0, disc_z_ = 0, disc_radius_ = 0;
  std::vector<Box> boxes_;  // at equal steps of r, each as large as its neighbourhood needs
};

}  // namespace etendue
