#include "henyey_greenstein.h"

#include "etendue/core/warp.h"

namespace etendue {

// Phase function (Henyey & Greenstein 1941, "Diffuse radiation in the galaxy", eq. 2). With theta the angle between the
// ways light travels before and after, and g = mean of cos(theta),
//     p(theta) = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos(theta))^(3/2))  [1/sr].
// Everything is written in h = 1 - cos(theta), found from the difference d of the two unit vectors as |d|^2 / 2, so that
// nothing cancels in the narrow peak of a large g:
//     1 + g^2 - 2 g cos(theta) = (1 - g)^2 + 2 g h.
// A negative g is the same function of the angle to the opposite way: below, g stands for its absolute value.
//
// Sampling. The probability of an angle up to theta is
//     P(h) = (1 - g^2) / (2 g) (1/(1 - g) - 1/s),  s = sqrt((1 - g)^2 + 2 g h).
// P(h) = u gives s = (1 - g)(1 + g) / q with q = 1 + g - 2 g u, and then
//     h = (s^2 - (1 - g)^2) / (2 g) = (1 - g)^2 u (1 + g + q) / q^2,
// in which g no longer divides: g = 0 gives h = 2u, the uniform sphere.
float HenyeyGreensteinVolume::phase(const Point3&, const Vector3& out, const Vector3& in) const {
  return value(length_squared(in - peak(out)) / 2);
}

Vector3 HenyeyGreensteinVolume::sample_phase(const Point3&, const Vector3& out, Point2 u, float& density) const {
  const float g = std::abs(anisotropy), q = 1 + g - 2 * g * u.x;
  const float h = std::min(square((1 - g) / q) * u.x * (1 + g + q), 2.0f), r = safe_sqrt(h * (2 - h));
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  density = value(h);
  return Frame(Normal3(peak(out))).to_world({r * cosine, r * sine, 1 - h});
}

/// p at an angle of 1 - cos = h to the peak.
float HenyeyGreensteinVolume::value(float h) const {
  const float g = std::abs(anisotropy), d = square(1 - g) + 2 * g * h;
  return (1 - g) * (1 + g) / (4 * pi * d * std::sqrt(d));
}

void HenyeyGreensteinVolume::check_anisotropy() const {
  if (!(std::abs(anisotropy) < 1)) fail("anisotropy", "must lie between -1 and 1, both excluded");
}

}  // namespace etendue
