#pragma once
// Fresnel's equations: the fraction of unpolarized light a smooth boundary reflects.

#include "etendue/core/spectrum.h"

namespace etendue {

/// The Fresnel reflectance of a boundary between two dielectrics, for unpolarized light. `cosine` >= 0 is that of the angle of
/// incidence, `eta` the index behind the boundary over that in front (Born & Wolf 1999, section 1.5.2):
/// R = (rs^2 + rp^2) / 2 with rs = (cos_i - eta cos_t) / (cos_i + eta cos_t), rp = (eta cos_i - cos_t) / (eta cos_i + cos_t)
/// and cos_t by Snell's law: the cosine of the refracted direction, returned in `cosine_behind` (0 under total internal
/// reflection).
inline float fresnel_dielectric(float cosine, float eta, float& cosine_behind) {
  const float c = clamp(cosine, 0, 1);
  const float behind_squared = 1 - (1 - c * c) / (eta * eta);
  if (behind_squared <= 0) {
    cosine_behind = 0;
    return 1;
  }
  cosine_behind = std::sqrt(behind_squared);
  if (c == 0) return 1;  // grazing incidence; for eta = 1 the formula would be 0/0
  const float rs = (c - eta * cosine_behind) / (c + eta * cosine_behind);
  const float rp = (eta * c - cosine_behind) / (eta * c + cosine_behind);
  return 0.5f * (rs * rs + rp * rp);
}
inline float fresnel_dielectric(float cosine, float eta) {
  float unused = 0;
  return fresnel_dielectric(cosine, eta, unused);
}

/// The reflectances of light polarized perpendicular to the plane of incidence (s) and in it (p); see fresnel_dielectric.
struct PolarizedReflectance {
  float s, p;
};
inline PolarizedReflectance fresnel_dielectric_polarized(float cosine, float eta, float& cosine_behind) {
  const float c = clamp(cosine, 0, 1);
  cosine_behind = safe_sqrt(1 - (1 - c * c) / (eta * eta));
  if (cosine_behind == 0 || c == 0) return {1, 1};
  return {square((c - eta * cosine_behind) / (c + eta * cosine_behind)),
          square((eta * c - cosine_behind) / (eta * c + cosine_behind))};
}

/// The Fresnel reflectance of a conductor in a dielectric, for unpolarized light; eta + i k is the conductor's complex index
/// over the dielectric's. With (a + i b)^2 = (eta + i k)^2 - sin^2 (Born & Wolf 1999, section 14.2):
/// Rs = (a^2 + b^2 + cos^2 - 2 a cos) / (a^2 + b^2 + cos^2 + 2 a cos),
/// Rp = Rs ((a^2 + b^2) cos^2 + sin^4 - 2 a cos sin^2) / ((a^2 + b^2) cos^2 + sin^4 + 2 a cos sin^2).
/// a^2 = (a^2 + b^2 + d) / 2 with d = eta^2 - k^2 - sin^2. For d < 0 this sum cancels, and a is computed from a b = eta k
/// instead.
inline float fresnel_conductor(float cosine, float eta, float k) {
  const float c = clamp(cosine, 0, 1), c2 = c * c, s2 = 1 - c2;
  const float d = eta * eta - k * k - s2, product = 2 * eta * k;
  const float sum = std::sqrt(d * d + product * product);  // a^2 + b^2
  const float a = d > 0 ? std::sqrt(0.5f * (sum + d)) : product > 0 ? product / std::sqrt(2 * (sum - d)) : 0;
  const float ac2 = 2 * a * c;
  const float s = (sum + c2 - ac2) / std::max(sum + c2 + ac2, 1e-20f);
  const float p = (sum * c2 + s2 * s2 - ac2 * s2) / std::max(sum * c2 + s2 * s2 + ac2 * s2, 1e-20f);
  return clamp(0.5f * s * (1 + p), 0, 1);
}
/// The same of all wavelengths at once.
inline Spectrum fresnel_conductor(float cosine, Spectrum eta, Spectrum k) {
  using Lanes = detail::Lanes;
  const auto root = [](Lanes x) {
    Lanes r;
    for (int i = 0; i < spectrum_size; ++i) r[i] = std::sqrt(x[i]);
    return r;
  };
  const Lanes n = eta.lanes(), kappa = k.lanes(), zero{}, one = zero + 1.0f, least = zero + 1e-20f;
  const float c = clamp(cosine, 0, 1), c2 = c * c, s2 = 1 - c2;
  const Lanes d = n * n - kappa * kappa - s2, product = 2 * n * kappa;
  const Lanes sum = root(d * d + product * product);
  const Lanes larger = root(0.5f * (sum + (d > zero ? d : -d))), smaller = product / (2 * larger);
  const Lanes a = d > zero ? larger : product > zero ? smaller : zero;
  const Lanes ac2 = 2 * a * c;
  const auto over = [&](Lanes x, Lanes y) { return x / (y > least ? y : least); };
  const Lanes s = over(sum + c2 - ac2, sum + c2 + ac2);
  const Lanes p = over(sum * c2 + s2 * s2 - ac2 * s2, sum * c2 + s2 * s2 + ac2 * s2);
  const Lanes r = 0.5f * s * (1 + p), low = r > zero ? r : zero;
  return Spectrum(low < one ? low : one);
}

/// The mean of fresnel_dielectric over diffuse illumination, the integral of 2 F(c) c dc over the cosine c. From the side of
/// the lower index (eta > 1) it has a closed form (Walsh 1926, in Duncan & Duntley 1942). The value for the other side follows
/// from reciprocity: the transmittance times the squared index on the side of incidence is the same from both sides, so 1 -
/// F(1/n) = (1 - F(n)) / n^2.
inline float mean_fresnel_dielectric(float eta) {
  const double n = eta < 1 ? 1.0 / double(eta) : double(eta);
  double f = 0;
  if (n < 1 + 1e-4) {
    f = (n - 1) / 3;  // first term of the series in n - 1: the closed form's terms cancel here
  } else {
    const double n2 = n * n, n4 = n2 * n2, p = n2 + 1, m = n4 - 1;
    f = 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
        n2 * (n2 - 1) * (n2 - 1) / (p * p * p) * std::log((n - 1) / (n + 1)) - 2 * n2 * n * (n2 + 2 * n - 1) / (p * m) +
        8 * n4 * (n4 + 1) / (p * m * m) * std::log(n);
  }
  return float(eta < 1 ? 1 - (1 - f) / (n * n) : f);
}

/// The mean of fresnel_conductor over diffuse illumination, by 4-point Gauss quadrature with weight c; error within 1e-3.
inline Spectrum mean_fresnel_conductor(Spectrum eta, Spectrum k) {
  constexpr float cosines[] = {0.13975986434f, 0.41640956763f, 0.72315698637f, 0.94289580388f};
  constexpr float weights[] = {0.06236194190f, 0.25969509522f, 0.40692913604f, 0.27101382684f};  // sum to 1
  Spectrum sum;
  for (int i = 0; i < 4; ++i) sum += weights[i] * fresnel_conductor(cosines[i], eta, k);
  return sum;
}

}  // namespace etendue
