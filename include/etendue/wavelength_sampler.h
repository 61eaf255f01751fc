#pragma once
// WavelengthSampler: the wavelengths of a path.

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

  /// Wavelengths for one sample; `u` is uniform in [0, 1). Densities are per nanometre, such that `to_xyz` estimates
  /// without bias. The key serves those that take turns over a pixel's samples; paths of one that looks at it cannot be
  /// mutated.
  virtual Wavelengths sample(SampleKey, float u) const = 0;
};

}  // namespace etendue
