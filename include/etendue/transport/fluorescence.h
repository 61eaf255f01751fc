#pragma once
// The estimators of fluorescence (etendue/reradiation.h): how a walk changes its wavelengths.
//
// A path has n wavelengths l_i, one in each lane, and the value of lane i belongs to the wavelength l_i of the film. At a
// fluorescent surface a walk chooses reradiation with a probability q, and elastic scattering with 1 - q. q is the share of
// reradiation in the light scattered if light of all wavelengths arrived alike (in importance, if all were asked for alike).
//
// From the camera (radiance), reradiation samples a new wavelength l'_i for each lane with the pdf p(l'_i) [1/nm], and
//     L_i = sum over the paths of  f |cos| L(l_i) / (1 - q)                             with the probability 1 - q,
//                                  Phi(l'_i -> l_i) r |cos| L(l'_i) / (q p(l'_i))       with the probability q.
// The walk goes on at the wavelengths l'_i: emission, next event estimation, media and all later vertices are those of l'_i,
// and the lane's value still is light of the film at l_i. So nothing changes after the vertex but the wavelengths, and the
// factors Phi / (q p) and 1 / (1 - q) are part of the vertex's scattering (ScaledScatter).
//
// Both ends (bidirectional path tracing, light tracing). Subpaths can be joined only at equal wavelengths. A sample therefore
// draws beforehand the number k of reradiations of its paths, with the probability P(k), and the wavelengths of all k + 1
// levels:
//     A_0, those of the film;  A_1 … A_k, each lane independent of the level before, with the pdf p_m(l) [1/nm].
// With one path of k reradiations x, the pixel's value is the sum over k of
//     int dA_1 … dA_k  f(x; A_0 … A_k),   f ~ prod_m Phi(A_m -> A_{m-1}),
// of which (1 / P(k)) prod_m 1 / p_m(A_m) f is a one-sample estimate, whatever strategy samples the vertices of x. Camera
// subpaths begin at the level 0 and step up at each reradiation, from A_{m-1} to A_m, light subpaths begin at the level k and
// step down; both multiply by Phi(A_m -> A_{m-1}) / p_m(A_m), in each lane, and by the choices' 1 / q or 1 / (1 - q). A
// connection joins vertices of equal level, next event estimation and emitter hits need the level k, connections to the lens
// the level 0: exactly the paths with k reradiations. At its last level a walk has nothing left to choose: q = 0.
//
// The weights of strategies for one path do not contain q, p_m and P: they are the same for all strategies, or left out by all,
// so that weights still sum to 1. Which vertices reradiate and at which level each segment lies are properties of the path.
//
// Dyes in media. With the dye's absorption coefficient a(l) [1/m], part of the extinction s, and its yield y (etendue/dye.h),
// the radiance along a ray through a medium has the further part
//     int_0^d T_l(t) int a(l') y(l' -> l) 1 / (4 pi) int L(in, l') d(in) dl' dt,
// since dyes in solution emit alike in all directions. With probability q the walk is absorbed by the dye on this segment, at a
// distance t with the pdf p(t), and counts T_l(t) a(l') y(l' -> l) / (q p(t) p(l')); otherwise it counts 1 / (1 - q) and passes
// or is scattered as usual. t cannot be sampled by the extinction: a dye may well be transparent at the wavelengths it emits.

#include <array>

#include "etendue/reradiation.h"
#include "etendue/transport/medium.h"
#include "etendue/transport/sample_context.h"

namespace etendue {

/// The wavelengths of the paths of a bidirectional sample, level by level.
class WavelengthLevels {
 public:
  /// Draws k, at most `most`, and the wavelengths for a film's wavelengths A_0. The levels lie in the arena.
  WavelengthLevels(const Wavelengths& film, int most, NumberStream, Arena&);

  int count() const { return count_; }      ///< k
  float weight() const { return weight_; }  ///< 1 / P(k)
  const Wavelengths& operator[](int level) const { return *levels_[size_t(level)]; }

 private:
  /// P(k) = (1 - r) r^k. A random number has 24 digits, and P(25) is less than the last of them.
  static constexpr float another = 0.5f;  // r
  static constexpr int limit = 24;
  std::array<const Wavelengths*, limit + 1> levels_{};
  int count_ = 0;
  float weight_ = 1;
};

/// Where a walk stands among levels. Without levels, which walks from luminaires need, it samples new wavelengths at each
/// reradiation.
struct WavelengthStep {
  const WavelengthLevels* levels = nullptr;
  int level = 0;
  Transport transport = Transport::radiance;
  /// Whether there is a further level.
  bool goes_on() const { return !levels || (transport == Transport::radiance ? level < levels->count() : level > 0); }
  int next() const { return transport == Transport::radiance ? level + 1 : level - 1; }
};

/// Chooses between elastic scattering by `elastic` (null: black) and, where the surface fluoresces, reradiation. `throughput`:
/// of the walk. After reradiation the sample's wavelengths are the new ones. Returns the scattering, whose value contains all
/// factors.
struct ChosenScatter {
  const Scatter* scatter = nullptr;
  bool reradiates = false;
};
ChosenScatter choose_reradiation(const SurfacePoint&, const Vector3& out, const Scatter* elastic, const Spectrum& throughput,
                                 SampleContext&, const WavelengthStep& = {});

/// Chooses whether the dye of a medium, if it has one, absorbs a walk on a segment of the length `reach` and reradiates its
/// light.
struct DyeFlight {
  bool absorbed = false;
  float distance = 0;  ///< to the place [m]
  Spectrum weight;     ///< of the throughput, also if it is not absorbed
};
DyeFlight sample_dye(const Medium&, const Ray&, float reach, const Spectrum& throughput, SampleContext&, const WavelengthStep&);

/// The medium of a vertex at which a dye emits, which scatters light alike in all directions.
Medium emitting_dye(const Medium&);

}  // namespace etendue
