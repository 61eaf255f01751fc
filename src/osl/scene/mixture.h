#pragma once
// Mixture: the BSDF of a sum of weighted closures, some of which lie below others.

#include "etendue/shader.h"

namespace etendue::osl {

struct MixturePart;

/// A layer over a part: the parts [begin, end) of the mixture reflect some light before it reaches the part.
struct Cover {
  int begin = 0, end = 0;
  Spectrum weight = Spectrum(1.0f);  ///< by which the whole of layer and base is multiplied, which the parts' weights include
  const Cover* next = nullptr;       ///< a layer over this one; null: none
};

struct MixturePart {
  const Scatter* scatter = nullptr;
  Spectrum weight;
  Lobes lobes = all_lobes;        ///< the lobes of the scatter that belong to the closure; the others are as if absent
  const Cover* covers = nullptr;  ///< the layers over the part
};

/// f = sum of w_k T_k f_k [1/sr]. T_k is what the layers over part k let through: the product over these layers of 1 - R(v), R
/// being the layer's albedo of reflection and v the direction in which light leaves. This is the albedo scaling that the
/// language's specification names for layer(); it is not reciprocal, and `transport` tells which of the directions is v, so
/// that the scattering of importance is the adjoint of that of radiance.
///
/// Parts may sum to more than all light, as weights are the author's: then f is that sum times `scale`, which depends on the
/// wavelength alone, so that what is reciprocal stays so.
///
/// Sampling: a part is chosen with the probability P_k, in proportion to w_k T_k times its albedo (see `promise` in
/// components/shaders/part_choice.h), and samples a direction. All parts could have sampled it, so the pdf is the sum of P_k
/// p_k, and the weight f |cos| over that sum: the balance heuristic. A specular sample has its part's own weight over P_k.
class Mixture final : public Scatter {
 public:
  static constexpr int most_parts = 32;

  /// `parts`: in memory that lives as long as the mixture; at most most_parts.
  Mixture(const SurfacePoint&, const MixturePart* parts, int count);

  /// Scales the sum so that its albedo is at most 1, as seen from some directions. Returns the largest albedo before.
  float limit();

 private:
  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext) const override;
  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext) const override;
  Spectrum world_albedo(const Vector3& out, Lobes) const override;

  /// w_k T_k for light that leaves in direction v; of the layers over the part only those before `until` count.
  Spectrum factor(const MixturePart&, const Vector3& v, const Cover* until = nullptr) const;
  /// Sets P_k of all parts for requested lobes; false: no part has any of them. The layers over a part count for radiance only:
  /// for importance they depend on the direction that is sampled.
  bool probabilities(const Vector3& out, ScatterContext, float* p) const;

  const MixturePart* parts_;
  int count_;
  Spectrum scale_ = Spectrum(1.0f);
};

}  // namespace etendue::osl
