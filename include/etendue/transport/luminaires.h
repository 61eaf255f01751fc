#pragma once
// Where paths from the light begin.

#include "etendue/light_sampler.h"
#include "etendue/numbers.h"
#include "etendue/scene.h"

namespace etendue {

/// Light that leaves a luminaire along a ray, with the densities it was chosen by.
struct EmittedLight {
  const SceneObject* luminaire = nullptr;
  SurfacePoint point;   ///< on the luminaire; of one at infinity: far outside the scene
  Ray ray;              ///< carries the light into the scene
  Spectrum radiance;    ///< that leaves along the ray, times the cosine at the luminaire
  float choice = 0;     ///< probability of the luminaire
  float position = 0;   ///< [1/m^2] on the luminaire; of one at infinity: across the ray
  float direction = 0;  ///< [1/sr]
  bool infinite = false;
  bool placed = false;  ///< `point` and `position` hold, though no light may leave there in the direction that was chosen
  /// What the light's throughput begins with.
  Spectrum throughput() const { return radiance / (choice * position * direction); }
};

/// Where, across its direction, light from infinity begins. All that has an end lies in the scene's sphere of radius R, and a
/// uniform point of the disc across the direction serves it. A surface without end lies beyond the disc as well, and there
/// every point must have a chance: with u uniform, r = R / (1 - u) has the density R / r^2, and a point at the distance r from
/// the axis R / (2 pi r^3). A camera at the height h above a plane sees, at the distance r, the area r^3 / h per solid angle:
/// so about as many points fall in each pixel, up to the horizon. Of two points one lies within the disc then:
///     p(r) = 1 / (2 pi R^2) for r < R,   R / (4 pi r^3) for r > R   [1/m^2],   and 1 / (pi R^2) in scenes without such
///     surfaces.
class EmissionPlane {
 public:
  explicit EmissionPlane(const Scene& scene)
      : centre_(scene.centre()), radius_(scene.radius()), endless_(scene.unbounded()), within_(1 / (pi * square(radius_))) {
    if (endless_) within_ /= 2;
  }

  const Point3& centre() const { return centre_; }
  /// The distance from the axis through the scene's centre and the azimuth around it, as x and y [m].
  Point2 sample(Point2 u) const;
  /// [1/m^2] across the direction, of the light that passes a point. Its place along the direction does not matter.
  float pdf(const Point3& p, const Vector3& direction) const {
    if (!endless_) return within_;
    const float r2 = length_squared(cross(p - centre_, direction));
    return r2 > square(radius_) ? radius_ / (4 * pi * r2 * std::sqrt(r2)) : within_;
  }

 private:
  Point3 centre_;
  float radius_;
  bool endless_;
  float within_;
};

/// The steps of which `sample_emitted_light` consists, for other ways to choose places and directions.
/// Chooses a luminaire by power. False: there is none.
bool choose_luminaire(const LightSampler&, float which, float time, EmittedLight&);
/// Light of a sampled point at infinity that passes through a point of the scene. False: it never begins.
bool emit_from_infinity(const Scene&, const Point3& through, const SurfaceSample&, const Wavelengths&, EmittedLight&);
/// Light of a sampled point that leaves in a direction.
void emit_from_point(const Scene&, const SurfaceSample&, const Vector3& direction, const Wavelengths&, EmittedLight&);

/// Chooses a luminaire by power, a point on it and a direction; for one at infinity a direction, and a place across it as
/// EmissionPlane has it. False: nothing leaves there.
bool sample_emitted_light(const Scene&, const LightSampler&, const Wavelengths&, float time, NumberStream&, EmittedLight&);

}  // namespace etendue
