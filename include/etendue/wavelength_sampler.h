#pragma once
// WavelengthSampler: samples the wavelengths of a path (in pbrt Film::SampleWavelengths, in Mitsuba
// Sensor::sample_wavelengths).
//
// A new wavelength sampler must implement `sample`.

#include "etendue/core/spectrum.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/sampler.h"

namespace etendue {

class WavelengthSampler : public Component {
 public:
  using Interface = WavelengthSampler;
  using Parent = Component;
  static void describe(Description<WavelengthSampler>&);

  /// Samples the wavelengths of one path by `u`, uniform in [0, 1). The pdfs are per nanometre, such that the estimate `to_xyz`
  /// is unbiased. The key is for samplers that cycle through wavelengths over a pixel's samples; with a sampler that uses it,
  /// paths cannot be mutated (Metropolis light transport).
  virtual Wavelengths sample(SampleKey, float u) const = 0;
};

}  // namespace etendue
