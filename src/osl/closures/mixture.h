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

  /// Of the requested lobes those that the part has.
  Lobes present(Lobes asked) const { return Lobes(scatter->lobes() & lobes & asked); }
};

/// f = sum of w_k T_k f_k [1/sr]. T_k is what the layers over part k let through: the product over these layers of 1 - R(v), R
/// being the layer's albedo of reflection and v the direction in which light leaves. This is the albedo scaling that the
/// language's specification names for layer(); it is not reciprocal, and `transport` tells which of the directions is v, so
/// that the scattering of importance is the adjoint of that of radiance.
///
/// Parts may sum to more than all light, as weights are the author's. With a(v) the albedo of the sum, seen from v, and s(v) =
/// min(1, 1 / a(v)), f is then that sum times min(s(out), s(in)). The factor is symmetric, so that what is reciprocal stays so,
/// and from no direction more than all light is scattered: a(out) s(out) <= 1. `may_exceed` says that weights allow a > 1;
/// sums that cannot are not looked at.
///
/// Sampling: a part is chosen with the probability P_k, in proportion to w_k T_k times its albedo (see `promise` in
/// components/shaders/part_choice.h), and samples a direction. All parts could have sampled it, so the pdf is the sum of P_k
/// p_k, and the weight f |cos| over that sum: the balance heuristic. A specular sample has its part's own weight over P_k.
class Mixture final : public Scatter {
 public:
  static constexpr int most_parts = 32;

  /// The albedos of a part from the last two directions that it was seen from: a path asks the same ones several times at a
  /// vertex. Only the thread that made the mixture keeps any: others may ask at the same time, as those that gather virtual
  /// lights do.
  struct Seen {
    Vector3 from[2];
    Lobes lobes[2] = {no_lobes, no_lobes};  ///< none: nothing is kept
    Spectrum albedo[2];
    int last = 0;
  };

  /// `parts` and `seen`: `count` each, at most most_parts, in memory that lives as long as the mixture.
  Mixture(const SurfacePoint&, const MixturePart* parts, Seen* seen, int count, bool may_exceed);

  /// The largest albedo of the sum as seen from a direction, without the factor that limits it.
  float unlimited_albedo(const Vector3& out) const { return sum_of_albedos(out, lobes_).maximum(); }

 private:
  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const override;
  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const override;
  Spectrum world_albedo(const Vector3& out, Lobes) const override;

  /// The albedo of a part's lobes, of which it has all.
  Spectrum albedo_of(int part, const Vector3& v, Lobes) const;
  /// w_k T_k for light that leaves in direction v; of the layers over the part only those before `until` count.
  Spectrum factor(int part, const Vector3& v, const Cover* until = nullptr) const;
  Spectrum sum_of_albedos(const Vector3& out, Lobes) const;
  /// s(v).
  Spectrum limit(const Vector3& v) const;
  /// min(s(out), s(in)).
  Spectrum limit(const Vector3& out, const Vector3& in) const;
  /// Sets P_k of all parts for requested lobes; false: no part has any of them. The layers over a part count for radiance only:
  /// for importance they depend on the direction that is sampled.
  bool probabilities(const Vector3& out, ScatterContext context, float* p) const;
  std::optional<ScatterSample> sample_straight(const Vector3& out, Transport) const;

  const MixturePart* parts_;
  Seen* seen_;
  const void* maker_;  ///< names the thread that keeps albedos
  int count_;
  bool may_exceed_;
};

}  // namespace etendue::osl
