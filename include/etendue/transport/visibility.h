#pragma once
// How much of the light gets along a ray: past surfaces that let it pass straight on, and through media.

#include "etendue/numbers.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "etendue/transport/medium_stack.h"

namespace etendue {

/// The fraction of light that gets along a shadow ray, per wavelength: 0 when something opaque lies on it. `media` are
/// those at the ray's origin, on the side it leaves to; null: vacuum, where nothing is tracked. Unbiased; exact for
/// homogeneous media and for surfaces that only pass light on or block it. The ray goes against the light (radiance) or along
/// with it (importance), for surfaces that are not the same for both. Numbers are used by media that differ from place to
/// place. `likely`, when given, gets the same with weighting_transmittance in place of what is drawn, where anything is visible
/// at all.
Spectrum shadow_transmittance_slowly(const Scene&, const Ray&, const MediumStack* media, const Wavelengths&, NumberStream&,
                                     Arena&, Transport, Spectrum* likely);

inline Spectrum shadow_transmittance(const Scene& scene, const Ray& ray, const MediumStack* media,
                                     const Wavelengths& wavelengths, NumberStream& numbers, Arena& arena,
                                     Transport transport = Transport::radiance, Spectrum* likely = nullptr) {
  if (likely) *likely = Spectrum(1.0f);
  if (!scene.has_null_surfaces() && (!media || media->empty())) [[likely]]
    return scene.any(ray) ? Spectrum() : Spectrum(1.0f);
  return shadow_transmittance_slowly(scene, ray, media, wavelengths, numbers, arena, transport, likely);
}

}  // namespace etendue
