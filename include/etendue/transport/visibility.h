#pragma once
// The transmittance of shadow rays: past null-scattering surfaces, and through media.

#include "etendue/numbers.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "etendue/transport/medium_stack.h"

namespace etendue {

/// The transmittance of a shadow ray per wavelength: 0 if it hits an opaque surface. `media` are those at the ray's origin, on
/// the side of its direction; null: vacuum, media are not tracked. Unbiased; exact for homogeneous media and for surfaces with
/// null scattering. `Transport` states whether the ray is traced against the light (radiance) or along with it (importance),
/// for surfaces that differ in the two. Heterogeneous media take random numbers. `likely`, if given, receives the same with
/// weighting_transmittance in place of the random estimate, for the weights of strategies; it is only valid if the
/// transmittance is not 0.
Spectrum shadow_transmittance_slowly(const Scene&, const Ray&, const MediumStack* media, const Wavelengths&, NumberStream&,
                                     Arena&, Transport, Spectrum* likely);

/// Receives the surfaces that a shadow ray passes by null scattering, in the order of the ray. `out` is opposite to the ray.
class NullCrossings {
 public:
  virtual void crossed(const Scatter&, const Vector3& out) = 0;

 protected:
  ~NullCrossings() = default;
};
/// The same, and tells of the surfaces that the ray passes, until one is opaque.
Spectrum shadow_transmittance_slowly(const Scene&, const Ray&, const MediumStack* media, const Wavelengths&, NumberStream&,
                                     Arena&, NullCrossings&);

inline Spectrum shadow_transmittance(const Scene& scene, const Ray& ray, const MediumStack* media,
                                     const Wavelengths& wavelengths, NumberStream& numbers, Arena& arena,
                                     Transport transport = Transport::radiance, Spectrum* likely = nullptr) {
  if (likely) *likely = Spectrum(1.0f);
  if (!scene.has_null_surfaces() && (!media || media->empty())) [[likely]]
    return scene.any(ray) ? Spectrum() : Spectrum(1.0f);
  return shadow_transmittance_slowly(scene, ray, media, wavelengths, numbers, arena, transport, likely);
}

}  // namespace etendue
