#pragma once
// Common parts of the two tone maps of Reinhard, Stark, Shirley & Ferwerda (2002). An exposed luminance L becomes
//   L_d = L (1 + L / L_white^2) / (1 + A),
// where A = L (equation 4), or the mean luminance around the pixel (equation 9, in the paper without L_white).

#include "etendue/describe/color.h"
#include "etendue/exposed_tone_map.h"
#include "gamut.h"
#include "luminance.h"

namespace etendue {

inline constexpr const char* reinhard_white_text =
    "luminance, after the exposure, that becomes white; 0: what 99.5 % of the pixels with light do not exceed, or 1 if that is "
    "less";

inline double reinhard_white(const Image& xyz, float said) {
  return said > 0 ? double(said) : std::max(1.0, white_luminance(xyz, 99.5));
}

/// Changes the luminance of each pixel and keeps its chromaticity, then maps colours outside the RGB space into it. `around(i)`
/// returns A of pixel i.
template <class F>
void develop_reinhard(Image& xyz, const RgbSpace& space, double white, F&& around) {
  for (size_t i = 0; i + 2 < xyz.values.size(); i += 3) {
    double* v = &xyz.values[i];
    const double scale = v[1] > 0 ? (1 + v[1] / (white * white)) / (1 + around(i / 3)) : 0;
    for (int c = 0; c < 3; ++c) v[c] *= scale;
  }
  draw_into_gamut(xyz, space);
}

}  // namespace etendue
