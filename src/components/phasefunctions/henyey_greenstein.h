#pragma once
// Henyey's and Greenstein's phase function (1941, "Diffuse radiation in the galaxy", eq. 2). With theta the angle between the
// directions of propagation before and after scattering, and g = mean of cos(theta),
//     p(theta) = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos(theta))^(3/2))  [1/sr].
// Everything is written in h = 1 - cos(theta), so that nothing cancels in the narrow peak of a large g:
//     1 + g^2 - 2 g cos(theta) = (1 - g)^2 + 2 g h.
//
// Sampling. The probability of an angle up to theta is
//     P(h) = (1 - g^2) / (2 g) (1/(1 - g) - 1/s),  s = sqrt((1 - g)^2 + 2 g h).
// P(h) = u gives s = (1 - g)(1 + g) / q with q = 1 + g - 2 g u, and then
//     h = (s^2 - (1 - g)^2) / (2 g) = (1 - g)^2 u (1 + g + q) / q^2,
// in which g no longer divides: g = 0 gives h = 2u, the uniform sphere.

#include <algorithm>
#include <cmath>

#include "etendue/core/math.h"

namespace etendue::henyey_greenstein {

/// [1/sr]
inline float value(float g, float h) {
  const float d = square(1 - g) + 2 * g * h;
  return (1 - g) * (1 + g) / (4 * pi * d * std::sqrt(d));
}

/// Samples h by a uniform number u.
inline float sample(float g, float u) {
  const float q = 1 + g - 2 * g * u;
  return std::min(square((1 - g) / q) * u * (1 + g + q), 2.0f);
}

}  // namespace etendue::henyey_greenstein
