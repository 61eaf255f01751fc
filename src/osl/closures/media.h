#pragma once
// Closures of participating media: coefficients and phase function of what a volume shader made.

#include "closure_models.h"
#include "etendue/volume_shader.h"

namespace etendue::osl {

/// The phase functions of a medium's closures at a point, each with its share of the scattering.
class PhaseMixture {
 public:
  static constexpr int most = 8;
  /// Throws Error if there are more than `most`.
  explicit PhaseMixture(const ClosureNode*);
  float value(const Vector3& out, const Vector3& in) const;
  Vector3 sample(const Vector3& out, Point2 u, float& pdf) const;

 private:
  struct Lobe {
    float anisotropy, share;
  };
  Lobe lobes_[most];
  int count_ = 0;
};

/// The coefficients [1/m] and the emission of the closure [W m^-3 sr^-1 nm^-1].
VolumeCoefficients medium_of(const ClosureNode*, const RgbSpace&, const Wavelengths&);

}  // namespace etendue::osl
