#pragma once
// Specular manifold sampling (Zeltner, Georgiev & Jakob 2020, "Specular manifold sampling for rendering high-frequency caustics
// and glints"): next event estimation through specular surfaces. It finds caustics without photons, also those that are seen
// through glass, and those of delta lights.
//
// At a smooth vertex b of a camera path (the receiver), a luminaire is chosen with the probability P, and a point a on it with
// the pdf p(a) [1/m^2] (at infinity a direction, with p [1/sr]). A seed chain from b is traced through specular surfaces, and
// Newton's method leads from it to a chain that ends at a (specular_chain.h): algorithm 1 of the paper. There may be several
// such chains; let p_k be the probability that a seed leads to the k-th. With w its direction at b and dw the solid angle at b
// of da, the estimate
//     f |cos| T L_e V |dw / da| / (P p(a) p_k)
// has the right expectation, the sum over all chains. T is the radiance that the chain carries, and
//     |dw / da| = |cos_a| / (|det J| R^2);   1 / (|det J| R^2) for a point light, 1 / |det J| at infinity.
// p_k is unknown, but seeds are independent trials: if N more of them are traced until one leads to the same chain again, the
// expectation of N is 1 / p_k (algorithm 2, after Booth 2007, "Unbiased Monte Carlo estimation of the reciprocal of an
// integral"). The biased variant traces a fixed number of seeds and adds all different chains that they find, each once
// (algorithm 3): it loses those that are missed, and has less variance.
//
// Few trials. N is large, and the estimate a firefly, where p_k is small. But for luminaires that rays can hit the trials may
// end after M: the expectation of min(N, M) is
//     sum over j < M of (1 - p_k)^j = a / p_k,   a = 1 - (1 - p_k)^M,
// so the estimate has a times the light of the chain. The rest, 1 - a = (1 - p_k)^M, is the probability that M seeds all miss
// the chain. So an emitter hit at its end traces M seeds of its own, and counts in full if all miss, else with the weight
// below: no light is lost, and no chain counts more than M times. M is the ratio of the pdfs below, p_m / p_b, at least 8:
// about from this p_k on emitter hits find the path more often.
//
// Seeds. p_k need not be known, so seeds may come from anywhere, if only each chain has some seeds that lead to it. Half start
// about straight towards a, as in manifold next event estimation (Hanika, Droske & Fascione 2015), since refraction bends light
// little; the others towards a random point in the box around a random object that casts caustics. Where a surface both
// reflects and refracts, reflection is chosen with a constant probability, and the chain ends at random. A seed belongs to a
// chain if it has the same lobes, and had the same choices of lobes; so the probability of its lobes is a known factor of p_k,
// and the N seeds have them by construction: N is then no greater for dim chains, which are reflected several times.
//
// Each path counts once. Emitter hits of the camera path find the same light, with the pdf of the receiver's direction times
// the share of power that the lobes scatter, p_b = p(w) share. Manifold sampling has the pdf p_m = P p(a) |da / dw| p_k; as
// the weights may be any functions of the path that sum to 1, the probability of the lobes times 1/4 stands for p_k. So, for
// the path light - s_m … s_1 - b,
//   - with 1 <= m <= the longest chain, all of which can be followed (specular_chain.h): the two strategies have the weights
//     p_m / (p_m + p_b) and p_b / (p_m + p_b), or those of the power heuristic. Delta lights have p_b = 0. Where the chain
//     focuses the luminaire, |da / dw| vanishes, and emitter hits, which see it large, have all of the weight;
//   - with longer chains, or one that cannot be followed, or a luminaire that manifold sampling does not choose (an even sky):
//     emitter hits alone. Those of delta lights are lost;
//   - with m = 0: next event estimation and emitter hits at b, as in any path tracer.
//
// Dispersion: the chain is that of the hero wavelength, and at its first dispersive refraction the others are dropped, as on
// any path.

#include <functional>
#include <vector>

#include "etendue/light_sampler.h"
#include "etendue/transport/multiple_importance.h"
#include "etendue/transport/path_layers.h"
#include "etendue/transport/specular_chain.h"

namespace etendue {

struct ManifoldSettings {
  int longest = ChainLobes::longest;  ///< specular vertices of a chain
  bool unbiased = true;
  int seeds = 16;  ///< of the biased variant
  Heuristic heuristic = Heuristic::power;
};

/// Light that a chain brings to a receiver.
struct ChainLight {
  int vertices = 0;  ///< m
  Spectrum light;    ///< scattered radiance, weighted [W m^-2 sr^-1 nm^-1]
  int trials = 0;    ///< M
  float weight = 1;  ///< of multiple importance sampling; already included in `light`
  const SceneObject* luminaire = nullptr;
  Vector3 in;      ///< w
  PathState path;  ///< with light path expressions: the backward state of the path up to the receiver
};

/// The strategy, for a scene and its luminaires. All functions may be called from many threads.
class ManifoldSampler {
 public:
  /// The light sampler must be built, and outlive it.
  ManifoldSampler(const Scene&, const LightSampler&, const ManifoldSettings&);

  /// Whether there is something that casts caustics, and a luminaire that it is chosen for.
  bool useful() const { return !up_to_.empty() && (!casters_.empty() || endless_casters_); }

  /// Samples light by chains of at most `longest` vertices, and calls `add` for each chain: at most one if unbiased.
  /// `aborted()` tells whether the result is needed no longer.
  void sample(const PathVertex& receiver, const Wavelengths&, int longest, NumberStream, Arena&,
              const std::function<bool()>& aborted, const std::function<void(const ChainLight&)>& add) const;

  /// The weight of an emitter hit at the end of a chain. `receiver` is the vertex at which the chain starts, with the media
  /// around it; its BSDF is not needed. `start` is the ray that left it, with the pdf p(w), `media` are those along it, and
  /// `longest` and the wavelengths those that `sample` had there. `hit` is the direction of the ray that hit the luminaire.
  float hit_weight(const PathVertex& receiver, const Ray& start, const MediumStack& media, float pdf, const ChainLobes&,
                   int longest, const SurfacePoint& luminaire, const Vector3& hit, const Wavelengths&, NumberStream,
                   Arena&) const;

 private:
  struct Trial;
  const SceneObject* choose(float u) const;
  double probability(const SceneObject& luminaire) const;
  struct Seed;
  bool seed(const Trial&, const Seed* wanted, Seed&) const;
  Vector3 seed_direction(const Trial&) const;
  std::optional<std::uint32_t> choices(const Trial&, const ChainLobes&, const Vector3& direction) const;
  bool found_again(const Trial&, const Seed& wanted, const ChainSolution&) const;
  static int most_trials(float p_m, float p_b);
  float weighting_pdf(double density, const ChainSolution&, const Seed&, const SurfacePoint& luminaire, const Vector3& to,
                      bool infinite) const;
  std::optional<ChainLight> light_of(const Trial&, const Seed&, const ChainSolution&) const;

  const Scene& scene_;
  const ManifoldSettings settings_;
  std::vector<const SceneObject*> luminaires_;  ///< that may be chosen
  std::vector<double> up_to_;                   ///< prefix sums of their probabilities
  std::vector<double> by_index_;                ///< the probability of each luminaire of the scene
  std::vector<Bounds3> casters_;
  bool endless_casters_ = false;
};

}  // namespace etendue
