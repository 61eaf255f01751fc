// HairFibre: the lobes of Chiang et al. 2016.

#include "components/shaders/fresnel.h"
#include "hair.h"

namespace etendue {
namespace {

/// log I0(x) for x >= 0 (modified Bessel function): its series (Abramowitz & Stegun 9.6.10) or, for large x, its
/// asymptotic expansion (9.7.1). Relative error of I0 below 1e-5.
float log_bessel_i0(float x) {
  if (x > 12) return x + 0.5f * std::log(1 / (2 * pi * x)) + std::log1p((0.125f + (0.0703125f + 0.0732422f / x) / x) / x);
  const float q = 0.25f * x * x;
  float term = 1, sum = 1;
  for (int k = 1; k < 40 && term > sum * 1e-7f; ++k) sum += term *= q / float(k * k);
  return std::log(sum);
}

/// The cumulative distribution of the logistic distribution of scale s.
float logistic_integral(float x, float s) { return 1 / (1 + std::exp(-x / s)); }

float wrapped(float angle) { return angle - 2 * pi * std::round(angle / (2 * pi)); }

}  // namespace

// The maps from roughness to the variance of M_p and the scale of N_p are fits that make equal steps look equal (eqs. 7 and 8).
// The residual lobe is as wide as TRT. Roughness 0 would be specular; roughness below 0.05 counts as 0.05.
HairFibre::HairFibre(float along, float around, float tilt, float eta) : around_(clamp(around, 0.05f, 1)), eta_(eta) {
  const float b = clamp(along, 0.05f, 1), n = around_;
  const float v = square(0.726f * b + 0.812f * b * b + 3.7f * std::pow(b, 20.0f));
  variance_ = {v, 0.25f * v, 4 * v, 4 * v};
  scale_ = 0.626657069f * (0.265f * n + 1.194f * n * n + 5.372f * std::pow(n, 22.0f));  // sqrt(pi / 8)
  scale_norm_ = logistic_integral(pi, scale_) - logistic_integral(-pi, scale_);
  const float angles[lobes] = {-2 * tilt, tilt, 4 * tilt, 0};
  for (size_t p = 0; p < lobes; ++p) {
    tilt_sine_[p] = std::sin(angles[p]);
    tilt_cosine_[p] = std::cos(angles[p]);
  }
}

// In projection along the fibre a ray is refracted as in a disc of the index eta' = sqrt(eta^2 - sin(theta)^2) / cos(theta)
// (Bravais; Marschner et al. 2003, appendix B). Each of its segments inside is 2 cos(gamma') / cos(theta') radii long. With F
// the Fresnel reflectance and T the transmittance of one segment,
//   A0 = F,   A1 = (1 - F)^2 T,   A2 = A1 F T,   A3 = A2 F T / (1 - F T)  (all the rest),
// whose sum is F + (1 - F)^2 T / (1 - F T), 1 for T = 1.
HairFibre::Section HairFibre::section(float sine, float cosine, float h, Spectrum absorption) const {
  Section s;
  // eta cos(theta'). In a denser medium grazing rays would be totally reflected and the root imaginary: hence the lower bound.
  const float inside = std::sqrt(std::max(eta_ * eta_ - sine * sine, 1e-6f));
  const float sine_offset = clamp(h * cosine / inside, -1, 1), cosine_offset = safe_sqrt(1 - sine_offset * sine_offset);
  s.offset_angle = safe_asin(h);
  s.offset_angle_inside = std::asin(sine_offset);
  const Spectrum t = exp(absorption * (-2 * cosine_offset * eta_ / inside));
  const float f = fresnel_dielectric(cosine * safe_sqrt(1 - h * h), eta_);
  s.attenuation[0] = Spectrum(f);
  s.attenuation[1] = t * square(1 - f);
  s.attenuation[2] = s.attenuation[1] * t * f;
  // F = 1 at the fibre's edge, where no light enters.
  s.attenuation[3] = f < 1 ? s.attenuation[2] * t * f / (Spectrum(1.0f) - t * f) : Spectrum();
  return s;
}

// The tilt alpha of the scales rotates each lobe towards the root by another angle: -2 alpha for R, alpha for TT, 4 alpha for
// TRT.
void HairFibre::tilted(int p, float& sine, float& cosine) const {
  const float s = tilt_sine_[size_t(p)], c = tilt_cosine_[size_t(p)], before = sine;
  sine = before * c + cosine * s;
  cosine = std::abs(cosine * c - before * s);
}

// The longitudinal profile of a Gaussian on the sphere (d'Eon et al. 2011):
//   M = exp(-sin_i sin_o / v) I0(cos_i cos_o / v) / (2 v sinh(1 / v)).
// Computed in logarithms, as both sinh and I0 overflow for narrow lobes; log(2 sinh(1/v)) = 1/v + log(1 - exp(-2/v)).
float HairFibre::longitudinal(int p, float sine_out, float cosine_out, float sine_in, float cosine_in) const {
  tilted(p, sine_out, cosine_out);
  const float v = variance_[size_t(p)], k = 1 / v;
  const float log_m = log_bessel_i0(cosine_in * cosine_out * k) - sine_in * sine_out * k - k - std::log1p(-std::exp(-2 * k));
  return std::exp(log_m) * k;
}

// Exact sampling (d'Eon et al. 2013, "A fiber scattering model with non-separable lobes"): the cosine c of the angle with the
// specular direction has a pdf proportional to exp(c / v) on [-1, 1].
float HairFibre::sample_longitudinal(int p, float sine_out, float cosine_out, Point2 u) const {
  tilted(p, sine_out, cosine_out);
  const float v = variance_[size_t(p)];
  const float t = std::min(-v * std::log(std::max(u.x, 0x1p-25f) + (1 - u.x) * std::exp(-2 / v)), 2.0f);  // 1 - c
  float unused = 0, cosine = 0;
  sin_cos_turn(u.y, unused, cosine);
  return clamp(-(1 - t) * sine_out + safe_sqrt(t * (2 - t)) * cosine * cosine_out, -1, 1);
}

float HairFibre::turn(int p, const Section& s) {
  return 2 * float(p) * s.offset_angle_inside - 2 * s.offset_angle + float(p) * pi;
}

// A logistic distribution around Phi (see `turn`), truncated at +-pi.
float HairFibre::azimuthal(int p, const Section& s, float difference) const {
  if (p == lobes - 1) return 0.5f * inverse_pi;
  const float e = std::exp(-std::abs(wrapped(difference - turn(p, s))) / scale_);
  return e / (scale_ * square(1 + e) * scale_norm_);
}

float HairFibre::sample_azimuthal(int p, const Section& s, float u) const {
  if (p == lobes - 1) return 2 * pi * u;
  const float q = std::max(u * scale_norm_ + logistic_integral(-pi, scale_), 1e-30f);
  return turn(p, s) + clamp(-scale_ * std::log(1 / q - 1), -pi, pi);
}

float HairFibre::azimuthal_share(int p, const Section& s, float from) const {
  if (p == lobes - 1) return 0.5f;
  const auto up_to = [this](float x) { return logistic_integral(x, scale_); };
  const float a = wrapped(from - turn(p, s));  // the interval is [a, a + pi]
  const float sum = a <= 0 ? up_to(a + pi) - up_to(a) : up_to(pi) - up_to(a) + up_to(a - pi) - up_to(-pi);
  return sum / scale_norm_;
}

Spectrum HairFibre::absorption_of(Spectrum color) const {
  const float n = around_, n2 = n * n, n4 = n2 * n2;
  const float scale = 5.969f - 0.215f * n + 2.532f * n2 - 10.73f * n2 * n + 5.574f * n4 + 0.245f * n4 * n;
  return map(color, [scale](float c) { return square(std::log(clamp(c, 1e-4f, 1)) / scale); });
}

}  // namespace etendue
