#pragma once
// Where paths from the light begin.

#include "etendue/light_sampler.h"
#include "etendue/sampler.h"
#include "etendue/scene.h"

namespace etendue {

/// Light that leaves a luminaire along a ray, with the densities it was chosen by.
struct EmittedLight {
  SurfacePoint point;   ///< on the luminaire; of one at infinity: far outside the scene
  Ray ray;              ///< carries the light into the scene
  Spectrum radiance;    ///< that leaves along the ray, times the cosine at the luminaire
  float choice = 0;     ///< probability of the luminaire
  float position = 0;   ///< [1/m^2] on the luminaire; of one at infinity: across the ray
  float direction = 0;  ///< [1/sr]
  bool infinite = false;
  /// What the light's throughput begins with.
  Spectrum throughput() const { return radiance / (choice * position * direction); }
};

/// Chooses a luminaire by power, a point on it and a direction; for one at infinity a direction, and a point of the disc
/// across it around the scene. False: nothing leaves there.
bool sample_emitted_light(const Scene&, const LightSampler&, const Wavelengths&, float time, SampleStream&, EmittedLight&);

}  // namespace etendue
