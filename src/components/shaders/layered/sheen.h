#pragma once
// SheenLobe: the lobe of velvet, peach fuzz and dust: upright fibres on a surface, which are bright at grazing angles.

#include "etendue/core/vector.h"

namespace etendue {

// Microfacets whose normals lie near the horizon (Estevez & Kulla 2017, "Production friendly microfacet sheen BRDF"):
//   f = D(m) / (4 |out.z in.z| (1 + lambda(out) + lambda(in)))   [1/sr],   m along out + in,
//   D(m) = (2 + 1/a) sin(m)^(1/a) / (2 pi)                                 (an exponential in place of a Gaussian),
// with the masking they fitted to it. Their softening of the terminator, which treats light and viewer differently, is left
// out: f is reciprocal. There is no Fresnel factor: fibres are white, and a color multiplies f.
//
// The directional albedo E(v) comes from a table; the fraction 1 - E(v) of the light reaches the layer below.
class SheenLobe {
 public:
  /// Roughness in [0, 1]; values below `sharpest` are raised to it.
  explicit SheenLobe(float roughness);
  static constexpr float sharpest = 0.1f;

  /// f [1/sr] of white fibres, for directions on the same side.
  float value(const Vector3& out, const Vector3& in) const;
  /// E(v).
  float albedo(const Vector3& v) const;
  /// The mean of E under diffuse light.
  float mean_albedo() const;

 private:
  friend class SheenTable;
  float masked(float cosine) const;

  float inverse_roughness_;
  float fit_[5];
  float row_;  ///< coordinate in the table
};

}  // namespace etendue
