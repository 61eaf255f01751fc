#pragma once
// Light sent where it is thrown on by mirrors and glass: Jensen's projection maps (1996, section 3.1), with spheres around such
// objects in their place. Of all light that leaves luminaires, caustics need only what meets such an object first.

#include <vector>

#include "etendue/transport/luminaires.h"

namespace etendue {

class ProjectionMap {
 public:
  /// Spheres around what has mirror-like lobes in a prepared scene; of very many such objects neighbours share one.
  explicit ProjectionMap(const Scene&);

  /// Whether sending light there alone saves anything: there are such objects, none without end, and they are smaller than the
  /// scene. What is not useful must not be used.
  bool useful() const { return useful_; }

  /// As etendue::sample_emitted_light, of light that goes towards a target; other light has no chance, and that which goes on
  /// to none of them by `sample_emitted_light` is all that is missing. From infinity a place is uniform over the discs of all
  /// targets, across the direction:
  ///     p = (how many of the discs it lies in) / sum pi r^2   [1/m^2].
  /// From elsewhere half of the directions are those of the emission shader, with its density p_e, the others uniform over the
  /// cones around targets:
  ///     p = 1/2 p_e + 1/2 (how many of the cones it lies in) / sum of the cones   [1/sr].
  bool sample_emitted_light(const Scene&, const LightSampler&, const Wavelengths&, float time, NumberStream&,
                            EmittedLight&) const;

 private:
  struct Sphere {
    Point3 centre;
    float radius;
  };
  void share(std::vector<Sphere>& spheres, size_t begin, size_t end, size_t most);
  Point3 place(Point2 u, const Vector3& direction, float& pdf) const;
  Vector3 direction(const SurfacePoint& from, Point2 u, float& pdf) const;
  int met_by(const Point3&, const Vector3& direction, bool ahead_alone) const;

  std::vector<Sphere> spheres_;
  std::vector<float> up_to_;  ///< sums of r^2 up to each sphere
  bool useful_ = false;
};

}  // namespace etendue
