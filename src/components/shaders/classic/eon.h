#pragma once
// The energy-preserving Oren-Nayar model, EON (Portsmouth, Kutz & Hill 2025, JCGT 14(1), arXiv 2410.18026), as a function, for
// shaders that have it as one lobe among others.

#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"

namespace etendue {

// With r the roughness, rho the albedo of single scattering, mu and mu' the cosines and s = out . in - mu mu', single
// scattering is Fujii's form of Oren & Nayar 1994,
//   f1 = rho A / pi (1 + r (s > 0 ? s / max(mu, mu') : s)),   A = 1 / (1 + (1/2 - 2/(3 pi)) r)   [1/sr],
// of albedo rho E(mu); and multiple scattering follows Kulla & Conty 2017,
//   f2 = rho2 / pi (1 - E(mu)) (1 - E(mu')) / (1 - Em),   rho2 = rho^2 Em / (1 - rho (1 - Em)),
// where Em is E's mean under diffuse light. The albedo is rho E + rho2 (1 - E): rho for r = 0, 1 for rho = 1.
class EonLobe {
 public:
  EonLobe(Spectrum color, float roughness) : r_(roughness), a_(1 / (1 + single * r_)), once_(color) {
    const float mean_lost = r_ * a_ * (single - mean);
    more_ = color * color * (1 - mean_lost) / (Spectrum(1.0f) - color * mean_lost);
  }

  /// f [1/sr] for directions on the same side.
  Spectrum value(const Vector3& out, const Vector3& in) const {
    if (r_ == 0) return once_ * inverse_pi;
    const float mu_out = std::abs(out.z), mu_in = std::abs(in.z), s = out.x * in.x + out.y * in.y;
    const float once = a_ * (1 + r_ * (s > 0 ? s / std::max(mu_out, mu_in) : s));
    const float more = r_ * a_ * lost_shape(mu_out) * lost_shape(mu_in) / (single - mean);
    return (once_ * std::max(once, 0.0f) + more_ * more) * inverse_pi;
  }
  Spectrum albedo(const Vector3& out) const {
    if (r_ == 0) return once_;
    const float lost = r_ * a_ * lost_shape(std::abs(out.z));
    return once_ * (1 - lost) + more_ * lost;
  }

 private:
  static constexpr float single = 0.5f - 2 / (3 * pi), mean = 2.0f / 3 - 28 / (15 * pi);
  /// (1 - E(mu)) / (r A), with (1 - S^3) / mu = mu (1 + S + S^2) / (1 + S), which stays exact at grazing angles.
  static float lost_shape(float mu) {
    const float sine = safe_sqrt(1 - mu * mu);
    const float g = sine * (std::acos(std::min(mu, 1.0f)) - sine * mu) +
                    (2.0f / 3) * sine * (mu * (1 + sine + sine * sine) / (1 + sine) - 1);
    return std::max(single - inverse_pi * g, 0.0f);
  }

  float r_, a_;
  Spectrum once_, more_;
};

}  // namespace etendue
