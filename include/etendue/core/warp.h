#pragma once
// Sampling functions: map uniform numbers to directions and points, with their pdfs. Sources: Pharr, Jakob & Humphreys,
// Physically Based Rendering, appendix A; Shirley & Chiu 1997 for the disc.

#include "etendue/core/vector.h"

namespace etendue::warp {

/// A point uniformly distributed in the unit disc (concentric map, which preserves neighbourhoods); pdf 1/pi [per unit area].
inline Point2 disc(Point2 u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) [[unlikely]]
    return {0, 0};
  // Either of the two is larger with probability 1/2, and a branch would be mispredicted half of the time: select by bit masks.
  const bool wide = std::abs(a) > std::abs(b);
  const float r = select(wide, a, b);
  // Only angles up to pi/4 occur: there the Taylor series up to x^9 is exact to the last bit of a float, and much faster than
  // the library's functions.
  const float x = (pi / 4) * (select(wide, b, a) / r), x2 = x * x;
  const float sine = x * (1 + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 * (1.0f / 362880)))));
  const float cosine = 1 + x2 * (-0.5f + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
  return {r * select(wide, cosine, sine), r * select(wide, sine, cosine)};
}

/// A unit direction with z >= 0, with pdf cos(theta)/pi [1/sr].
inline Vector3 cosine_hemisphere(Point2 u) {
  const Point2 d = disc(u);
  // The point's distance from the centre, which does not depend on the computation of the point.
  const float r = std::max(std::abs(2 * u.x - 1), std::abs(2 * u.y - 1));
  return {d.x, d.y, safe_sqrt((1 - r) * (1 + r))};
}
inline float cosine_hemisphere_pdf(float cosine) { return std::max(cosine, 0.0f) * inverse_pi; }

/// A unit direction, uniform over the sphere; pdf 1/(4 pi) [1/sr].
inline Vector3 sphere(Point2 u) {
  const float z = 1 - 2 * u.x, r = safe_sqrt(1 - z * z);
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  return {r * cosine, r * sine, z};
}
inline constexpr float sphere_pdf = 1 / (4 * pi);

/// A unit direction, uniform over the hemisphere z >= 0; pdf 1/(2 pi) [1/sr].
inline Vector3 hemisphere(Point2 u) {
  const float r = safe_sqrt(1 - u.x * u.x);
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  return {r * cosine, r * sine, u.x};
}
inline constexpr float hemisphere_pdf = 1 / (2 * pi);

/// A unit direction, uniform in a cone around +z. The cone is given by 1 - cos(half angle), so that narrow cones stay exact.
inline Vector3 cone(Point2 u, float one_minus_cosine) {
  const float h = u.x * one_minus_cosine;  // 1 - cos(theta)
  const float r = safe_sqrt(h * (2 - h));
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  return {r * cosine, r * sine, 1 - h};
}
/// [1/sr]
inline float cone_pdf(float one_minus_cosine) { return 1 / (2 * pi * one_minus_cosine); }

/// A unit direction with pdf (n + 1)/(2 pi) cos(theta)^n [1/sr] around +z.
inline Vector3 power_cosine(Point2 u, float n) {
  const float z = std::pow(u.x, 1 / (n + 1)), r = safe_sqrt(1 - z * z);
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  return {r * cosine, r * sine, z};
}
inline float power_cosine_pdf(float cosine, float n) { return cosine > 0 ? (n + 1) / (2 * pi) * std::pow(cosine, n) : 0; }

/// Barycentric coordinates (of the second and third vertex), uniform over a triangle; pdf 1/area.
/// (Heitz 2019, "A low-distortion map between triangle and square".)
inline Point2 triangle(Point2 u) {
  float b0 = 0, b1 = 0;
  if (u.x < u.y) {
    b0 = u.x / 2;
    b1 = u.y - b0;
  } else {
    b1 = u.y / 2;
    b0 = u.x - b1;
  }
  return {b1, 1 - b0 - b1};
}

}  // namespace etendue::warp
