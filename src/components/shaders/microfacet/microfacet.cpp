// Microfacet distributions: Beckmann's masking, and sampling of visible normals.

#include "microfacet.h"

namespace etendue {
namespace {

constexpr float inverse_sqrt_pi = 0.56418958354775628695f;

/// The inverse of the error function on (-1, 1), to about 3e-7 of its value (Giles 2010, "Approximating the erfinv
/// function", single precision).
float inverse_erf(float y) {
  float w = -std::log((1 - y) * (1 + y));
  if (w < 5) {
    w -= 2.5f;
    constexpr float c[] = {2.81022636e-08f, 3.43273939e-07f, -3.5233877e-06f, -4.39150654e-06f, 0.00021858087f,
                           -0.00125372503f, -0.00417768164f, 0.246640727f,    1.50140941f};
    float p = c[0];
    for (int i = 1; i < 9; ++i) p = p * w + c[i];
    return p * y;
  }
  w = std::sqrt(w) - 3;
  constexpr float c[] = {-0.000200214257f, 0.000100950558f, 0.00134934322f, -0.00367342844f, 0.00573950773f,
                         -0.0076224613f,   0.00943887047f,  1.00167406f,    2.83297682f};
  float p = c[0];
  for (int i = 1; i < 9; ++i) p = p * w + c[i];
  return p * y;
}

}  // namespace

// lambda = (exp(-a^2) / (a sqrt(pi)) - erfc(a)) / 2 with a the cotangent of v's angle over the alpha along v (Heitz 2014,
// section 5.3). erfc(a) = exp(-a^2) p(1 / (1 + 0.3275911 a)) to 1.5e-7 (Abramowitz & Stegun 7.1.26); beyond a = 4 lambda is
// below 1e-8.
float MicrofacetDistribution::beckmann_lambda(const Vector3& v) const {
  const float a = std::abs(v.z) / std::max(std::sqrt(square(alpha_x * v.x) + square(alpha_y * v.y)), 1e-30f);
  if (a > 4) return 0;
  const float t = 1 / (1 + 0.3275911f * a);
  const float p = t * (0.254829592f + t * (-0.284496736f + t * (1.421413741f + t * (-1.453152027f + t * 1.061405429f))));
  return 0.5f * std::exp(-a * a) * std::max(inverse_sqrt_pi / std::max(a, 1e-20f) - p, 0.0f);
}

// Stretched to alpha 1, the surface has the normal distribution of a hemisphere, and is seen from the stretched direction.
// Reflecting that direction about the visible normals of the hemisphere gives directions uniform on a spherical cap (Dupuy &
// Benyoub 2023, "Sampling visible GGX normals with spherical caps"). Its half-vector with the stretched direction is the
// visible normal, which is then stretched back.
Vector3 MicrofacetDistribution::sample_visible_ggx(const Vector3& v, Point2 u) const {
  const Vector3 w = normalize(Vector3{alpha_x * v.x, alpha_y * v.y, v.z});
  const float z = (1 - u.x) * (1 + w.z) - w.z, r = safe_sqrt(1 - z * z);
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  return normalize(Vector3{alpha_x * (r * cosine + w.x), alpha_y * (r * sine + w.y), std::max(z + w.z, 1e-7f)});
}

// After the same stretch, and a rotation of v into the xz plane, slopes (x, y) of facets have the pdf exp(-x^2 - y^2) / pi, and
// visible slopes this times max(c - s x, 0) / norm, with c, s the cosine and sine of v's angle with the normal (Heitz & d'Eon
// 2014; a slope x > 0 leans away from v). y is normally distributed; x has the cumulative distribution
//   H(x) = c (1 + erf x) / 2 + s exp(-x^2) / (2 sqrt pi)   up to x = c / s, over H(c / s).
// As in Jakob 2014, "An improved visible normal sampling routine for the Beckmann distribution", the unknown is e = erf x:
// dH/de = (c - s x) / 2 falls towards 0, so H is concave, and Newton iterates that start below the root stay below it and
// increase; one that starts above is below after one step.
Vector3 MicrofacetDistribution::sample_visible_beckmann(const Vector3& v, Point2 u) const {
  const Vector3 w = normalize(Vector3{alpha_x * v.x, alpha_y * v.y, v.z});
  const float c = w.z, s = std::sqrt(w.x * w.x + w.y * w.y);
  float x = 0;
  constexpr float almost = one_minus_epsilon;
  const float across = inverse_erf(clamp(2 * u.y - 1, -almost, almost));
  if (s < 1e-4f) {
    x = inverse_erf(clamp(2 * u.x - 1, -almost, almost));
  } else {
    const float highest = std::min(std::erf(c / s), almost), end = c / s;
    const auto cumulative = [&](float erf_x, float slope) {
      return 0.5f * (c * (1 + erf_x) + s * inverse_sqrt_pi * std::exp(-slope * slope));
    };
    const float wanted = u.x * cumulative(highest, std::min(end, inverse_erf(highest)));
    // Initial guess, exact for u = 0 and u = 1.
    float e = clamp(-1 + (1 + highest) * (c * u.x + s * (1 - std::sqrt(1 - u.x))) / (c + s), -almost, highest);
    x = inverse_erf(e);
    for (int i = 0; i < 12; ++i) {
      const float slope = 0.5f * (c - s * x);
      if (!(slope > 0)) break;
      const float step = (wanted - cumulative(e, x)) / slope;
      const float next = clamp(e + step, -almost, highest);
      const bool done = std::abs(next - e) < 1e-6f * (1 + e) || next == e;
      e = next;
      x = inverse_erf(e);
      if (done) break;
    }
    x = std::min(x, end);
  }
  // Rotated back and stretched; the normal is along (-slope, 1).
  const float cosine = s > 0 ? w.x / s : 1, sine = s > 0 ? w.y / s : 0;
  return normalize(Vector3{-alpha_x * (cosine * x - sine * across), -alpha_y * (sine * x + cosine * across), 1});
}

}  // namespace etendue
