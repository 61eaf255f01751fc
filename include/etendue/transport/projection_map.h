#pragma once
// ProjectionMap: emission of light towards specular objects only, for caustics. It is the projection map of Jensen (1996,
// section 3.1), with bounding spheres of these objects in place of a map of directions. Of all emitted light, caustics need
// only that which hits such an object first.

#include <vector>

#include "etendue/transport/luminaires.h"

namespace etendue {

/// Whether an object, or one inside it, has specular lobes (null scattering aside), and so casts caustics.
bool casts_caustics(const SceneObject&);

class ProjectionMap {
 public:
  /// Bounding spheres of the objects of a prepared scene that have specular lobes; of very many such objects, neighbours share
  /// one.
  explicit ProjectionMap(const Scene&);

  /// Whether emission towards the spheres alone saves anything: there are such objects, none of them unbounded, and they are
  /// smaller than the scene. Otherwise the map must not be used.
  bool useful() const { return useful_; }

  /// Like etendue::sample_emitted_light, for light that goes towards a sphere. All such light is sampled; other light may be
  /// missing. From infinity the rays are uniform over the discs of all spheres, across the direction:
  ///     p = (number of discs that contain the point) / sum pi r^2   [1/m^2].
  /// From a point of a luminaire, half of the directions are sampled by the emission shader, with its pdf p_e, the others
  /// uniformly over the cones around the spheres:
  ///     p = 1/2 p_e + 1/2 (number of cones that contain the direction) / sum of the solid angles of the cones   [1/sr].
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
  std::vector<float> up_to_;  ///< prefix sums of r^2
  bool useful_ = false;
};

}  // namespace etendue
