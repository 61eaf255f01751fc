#pragma once
// DiffusionProfile: how light that enters a scattering half space spreads before it leaves again.
//
// Christensen & Burley 2015, "Approximate reflectance profiles for efficient subsurface scattering" (eq. 2): light that enters
// at a point and leaves again has, by the distance r along the surface, the pdf
//     R(r) = (exp(-r / d) + exp(-r / 3d)) / (8 pi d r)      [1/m^2],       integral of R 2 pi r dr = 1,
// which fits simulations of isotropic scattering. For light that is diffuse below the surface (their eq. 6), albedo A and
// mean free path l,      d = l / (1.9 - A + 3.5 (A - 0.8)^2).
//
// These simulations have no reflecting boundary. Under one that reflects the fraction F of diffuse light back inside, a body of
// albedo A0 returns A = A0 (1 - F) / (1 - A0 F), after 1 / (1 - A0 F) rounds inside on average. d is that of A0 times the
// number of rounds: for A from 0.2 to 0.9 and indices up to 1.6 the median radius then agrees with that of a random walk within
// 11 %.
//
// 2 pi r R is a mixture of two exponential pdfs, by one quarter one with mean d and by three quarters one with mean 3 d: radii
// are sampled from this mixture. R is truncated at 24 d and rescaled to keep its integral, of which 0.025 % lies beyond.

#include "etendue/core/math.h"

namespace etendue {

class DiffusionProfile {
 public:
  DiffusionProfile() = default;
  explicit DiffusionProfile(float d) : d_(d) {}
  /// d [m] from the transport mean free path [m] and the mean reflectance F of the boundary from inside.
  static float scale(float albedo, float mean_free_path, float reflected = 0) {
    const float inner = albedo / (1 - reflected + albedo * reflected);  // A0
    return mean_free_path / ((1.9f - inner + 3.5f * square(inner - 0.8f)) * (1 - inner * reflected));
  }

  /// The radius at which the profile is truncated [m].
  float end() const { return end_over_d * d_; }
  /// R(r) [1/m^2]
  float by_area(float r) const {
    if (r > end()) return 0;
    const float x = std::max(r / d_, 1e-9f);
    return (std::exp(-x) + std::exp(-x / 3)) / (8 * pi * x * d_ * d_ * kept);
  }
  /// Samples a radius [m] with the pdf 2 pi r R(r) [1/m].
  float sample(float u) const {
    const float t = u * kept;
    const float x =
        t < narrow ? -std::log1p(-t / narrow * (4 * narrow)) : -3 * std::log1p(-(t - narrow) / wide * (4 * wide / 3));
    return std::min(x * d_, end());
  }
  /// The fraction that leaves within a radius.
  float within(float r) const {
    const float x = std::min(r / d_, end_over_d);
    return (1 - 0.25f * std::exp(-x) - 0.75f * std::exp(-x / 3)) / kept;
  }

 private:
  static constexpr float end_over_d = 24;
  static constexpr float narrow = 0.25f * (1 - 3.775e-11f), wide = 0.75f * (1 - 3.3546263e-4f);  // 1 - exp(-24), 1 - exp(-8)
  static constexpr float kept = narrow + wide;

  float d_ = 1;
};

}  // namespace etendue
