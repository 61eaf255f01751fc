#pragma once
// SchlickLobe: the microfacet lobe of Schlick 1994: its factors, their exact sampling, and an upper bound of the albedo.

#include "components/shaders/half_vector.h"

namespace etendue {

// For a roughness r and an isotropy p in (0, 1] (Schlick 1994), w being the cosine of h's azimuth:
//   zenith  Z(t) = r / (1 + r t^2 - t^2)^2          azimuth  A(w) = sqrt(p / (p^2 - p^2 w^2 + w^2))
//   shadow  G(v) = v / (r - r v + v)
//   lobe    D = G(v) G(v') Z(t) A(w) / (4 pi v v')  [1/sr].
// p = 1 is isotropic, A = 1; scratches along x spread the light across x.
//
// Sampling. The integral of Z t over the hemisphere of h is pi; t^2 = a / (r - a r + a) for uniform a. The mean of A over the
// azimuth, called `mean` here, is the complete elliptic integral 2 sqrt(p) K / pi = sqrt(p) / M(1, p), with M the
// arithmetic-geometric mean; it is at most 1, as M(1, p) >= sqrt(p). The paper's own formula for the azimuth does not sample A;
// the exact one is Jacobi's amplitude, phi = am(K x) in each quarter turn x, by descending Landen steps (Abramowitz & Stegun
// 16.4). So the pdf of h is Z A t / (pi mean) [1/sr], and the albedo of D is the average over sampled h of mean G(v') u / (t (v
// (1 - r) + r)).
//
// Energy. This albedo exceeds 1 at grazing angles where r < 1/4, because G masks less than a surface of such slopes does
// (Smith's masking function for the same Z sets in at v of about sqrt(r), G at about r). As G(v') <= 1, the albedo is at most
//   B(v) = (integral of Z A max(u, 0) / pi over h) / (v (1 - r) + r).
// For p = 1 the integral is (v + sqrt(r + (1 - r) v^2)) / 2. Otherwise there are two bounds. h and h rotated by half a turn are
// equally probable; the average of their u is largest when all h are in the azimuth of `out`, so the integral is at most mean
// (v + sqrt(r) s / 2 atan(sqrt(r) s / v)) with s the sine of `out`. And A <= 1 / sqrt(p), so it is at most the isotropic one
// over sqrt(p). So D / max(1, B(v), B(v')) is reciprocal, equal to D where no bound exceeds 1, and never creates energy.
class SchlickLobe {
 public:
  SchlickLobe() = default;
  SchlickLobe(float roughness, float isotropy) : r_(roughness), p_(isotropy) {
    if (p_ >= 1) return;
    float a = 1, b = p_;
    for (int i = 0; i < landen_steps; ++i) {
      const float mean = 0.5f * (a + b);
      b = std::sqrt(a * b);
      a = mean;
    }
    mean_ = std::sqrt(p_) / a;
  }

  Vector3 sample(Point2 u) const {
    const float cosine_part = u.x, sine_part = r_ * (1 - u.x), sum = cosine_part + sine_part;
    const float t = std::sqrt(cosine_part / sum), s = std::sqrt(sine_part / sum);
    float sine = 0, cosine = 0;
    azimuth(u.y, sine, cosine);
    return {s * cosine, s * sine, t};
  }
  /// The pdf of h [1/sr].
  float pdf(const HalfVector& half) const { return factors(half) * half.h.z * inverse_pi / mean_; }
  /// D / max(1, B(v), B(v')) [1/sr].
  float value(float v_out, float v_in, const HalfVector& half) const {
    return factors(half) / (4 * pi * open(v_out) * open(v_in) * excess(v_out, v_in));
  }
  /// The sampling weight: the value times the cosine of `in` over the pdf, for `in` reflected about a sampled h.
  float weight(float v_out, float v_in, float u, float t) const {
    return mean_ * v_in * u / (t * open(v_out) * open(v_in) * excess(v_out, v_in));
  }

 private:
  static constexpr int landen_steps = 6;  // quadratic convergence: enough for p >= 1e-4

  /// v / G(v)
  float open(float v) const { return v * (1 - r_) + r_; }
  /// max(1, B(v), B(v'))
  float excess(float v_out, float v_in) const { return std::max({1.0f, bound(v_out), bound(v_in)}); }
  float bound(float v) const {
    float integral = 0.5f * (v + std::sqrt(r_ + (1 - r_) * v * v));
    if (p_ < 1) {
      const float x = std::sqrt(r_ * std::max(1 - v * v, 0.0f));
      integral = std::min(integral / std::sqrt(p_), mean_ * (v + 0.5f * x * std::atan2(x, v)));
    }
    return integral / open(v);
  }
  /// Z(t) A(w), both without cancellation: 1 + r t^2 - t^2 = r t^2 + (1 - t^2).
  float factors(const HalfVector& half) const {
    const Vector3& h = half.h;
    const float s2 = half.sine_squared(), zenith = r_ / square(r_ * h.z * h.z + s2);
    if (p_ >= 1) return zenith;
    const float azimuth = s2 > 0 ? std::sqrt(p_ * s2 / (p_ * p_ * h.y * h.y + h.x * h.x)) : 1;
    return zenith * azimuth;
  }

  void azimuth(float u, float& sine, float& cosine) const {
    if (p_ >= 1) return sin_cos_turn(u, sine, cosine);
    float a[landen_steps + 1] = {1}, c[landen_steps + 1], b = p_;
    int n = 0;
    while (n < landen_steps && std::abs(a[n] - b) > 1e-6f) {
      a[n + 1] = 0.5f * (a[n] + b);
      c[n + 1] = 0.5f * (a[n] - b);
      b = std::sqrt(a[n] * b);
      ++n;
    }
    // phi_N = 2^N a_N K x with K = pi / (2 a_N); back by sin(2 phi_(n-1) - phi_n) = c_n / a_n sin(phi_n).
    const float quarters = 4 * u, q = std::floor(quarters), x = quarters - q;
    float phi = float(1 << n) * (pi / 2) * x;
    for (; n > 0; --n) phi = 0.5f * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
    sine = std::sin(phi);
    cosine = std::cos(phi);
    const int quarter = int(q);
    if (quarter == 1 || quarter == 2) cosine = -cosine;
    if (quarter >= 2) sine = -sine;
  }

  float r_ = 1, p_ = 1, mean_ = 1;
};

}  // namespace etendue
