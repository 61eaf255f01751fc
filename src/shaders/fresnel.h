#pragma once
// Fresnel's equations.

#include "etendue/spectrum.h"

namespace etendue {

/// The fraction of unpolarised light a smooth boundary between two dielectrics reflects. `cosine` >= 0 is that of the
/// angle of incidence, `eta` the index behind the boundary over that in front (Born & Wolf 1999, section 1.5.2):
/// R = (rs^2 + rp^2) / 2 with rs = (cos_i - eta cos_t) / (cos_i + eta cos_t), rp = (eta cos_i - cos_t) / (eta cos_i + cos_t)
/// and Snell's law for cos_t, the cosine behind, which is returned as well (0 under total reflection).
inline float fresnel_dielectric(float cosine, float eta, float& cosine_behind) {
  const float c = clamp(cosine, 0, 1);
  const float behind_squared = 1 - (1 - c * c) / (eta * eta);
  if (behind_squared <= 0) {
    cosine_behind = 0;
    return 1;
  }
  cosine_behind = std::sqrt(behind_squared);
  if (c == 0) return 1;  // also where eta = 1 leaves 0/0
  const float rs = (c - eta * cosine_behind) / (c + eta * cosine_behind);
  const float rp = (eta * c - cosine_behind) / (eta * c + cosine_behind);
  return 0.5f * (rs * rs + rp * rp);
}

}  // namespace etendue
