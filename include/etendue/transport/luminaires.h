#pragma once
// EmittedLight: the origin of light subpaths. A luminaire is chosen with probability P, a point on it with the pdf p_A [1/m^2]
// and a direction with the pdf p_w [1/sr]; the initial throughput is the flux
//     T_0 = L_e |cos| / (P p_A p_w)   [W/nm].

#include "etendue/light_sampler.h"
#include "etendue/numbers.h"
#include "etendue/scene.h"

namespace etendue {

/// Light that leaves a luminaire along a ray, with the pdfs by which it was sampled.
struct EmittedLight {
  const SceneObject* luminaire = nullptr;
  SurfacePoint point;       ///< on the luminaire; for one at infinity far outside the scene
  Ray ray;                  ///< carries the light into the scene
  Spectrum radiance;        ///< along the ray, times the cosine at the luminaire
  float probability = 0;    ///< P, of the luminaire
  float pdf_position = 0;   ///< p_A [1/m^2] on the luminaire; for one at infinity on the plane across the ray
  float pdf_direction = 0;  ///< p_w [1/sr]
  bool infinite = false;
  bool placed = false;  ///< `point` and `pdf_position` are valid, even if no light is emitted in the sampled direction
  /// T_0 of the light subpath.
  Spectrum throughput() const { return radiance / (probability * pdf_position * pdf_direction); }
};

/// The plane across the direction of light from infinity on which its rays are sampled. All bounded objects lie in the scene's
/// bounding sphere of radius R, and a uniform point on the disc across the direction is enough for them. Unbounded surfaces
/// extend beyond the disc, and every point there must have a positive pdf: with u uniform, r = R / (1 - u) has the pdf R / r^2,
/// and a point at the distance r from the axis has the pdf R / (2 pi r^3). A camera at the height h above a plane sees, at the
/// distance r, the area r^3 / h per solid angle: so about the same number of points falls in each pixel, up to the horizon.
/// Half of the points are sampled on the disc then:
///     p(r) = 1 / (2 pi R^2) for r < R,   R / (4 pi r^3) for r > R   [1/m^2],   and 1 / (pi R^2) in scenes without such
///     surfaces.
class EmissionPlane {
 public:
  explicit EmissionPlane(const Scene& scene)
      : centre_(scene.centre()), radius_(scene.radius()), endless_(scene.unbounded()), within_(1 / (pi * square(radius_))) {
    if (endless_) within_ /= 2;
  }

  const Point3& centre() const { return centre_; }
  /// A point on the plane, relative to the scene's centre [m].
  Point2 sample(Point2 u) const;
  /// The pdf [1/m^2] on the plane of the ray through a point. The position of the point along the direction does not matter.
  float pdf(const Point3& point, const Vector3& direction) const {
    if (!endless_) return within_;
    const float r2 = length_squared(cross(point - centre_, direction));
    return r2 > square(radius_) ? radius_ / (4 * pi * r2 * std::sqrt(r2)) : within_;
  }

 private:
  Point3 centre_;
  float radius_;
  bool endless_;
  float within_;
};

/// The steps of `sample_emitted_light`, for other ways to sample points and directions. Chooses a luminaire by power. False:
/// there is none.
bool choose_luminaire(const LightSampler&, float which, float time, EmittedLight&);
/// Light from a sampled point at infinity along the ray through a point of the scene. False: the ray has no origin outside all
/// surfaces.
bool emit_from_infinity(const Scene&, const Point3& through, const SurfaceSample&, const Wavelengths&, EmittedLight&);
/// Light from a sampled point in a direction.
void emit_from_point(const Scene&, const SurfaceSample&, const Vector3& direction, const Wavelengths&, EmittedLight&);

/// Chooses a luminaire by power and samples a point on it and a direction; for one at infinity a direction, and a point on the
/// plane across it (EmissionPlane). False: no light is emitted there.
bool sample_emitted_light(const Scene&, const LightSampler&, const Wavelengths&, float time, NumberStream&, EmittedLight&);

}  // namespace etendue
