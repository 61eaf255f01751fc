#pragma once
// Gamut mapping of colours outside an RGB space, for tone maps that change only the luminance.

#include "color_matrix.h"
#include "etendue/core/image.h"
#include "etendue/describe/color.h"

namespace etendue {

/// Mixes each colour with the grey of its luminance until its components lie in [0, 1]. The luminance and the direction from
/// white, the hue, are kept. Colours of luminance above 1 become white.
inline void draw_into_gamut(Image& xyz, const RgbSpace& space) {
  for (size_t i = 0; i + 2 < xyz.values.size(); i += 3) {
    double* v = &xyz.values[i];
    const double grey = std::clamp(v[1], 0.0, 1.0);
    ColorTriple c = space.from_xyz * ColorTriple{v[0], v[1], v[2]};
    double kept = v[1] < 1 ? 1 : 0;
    for (const double x : c) {
      if (x > 1) kept = std::min(kept, (1 - grey) / (x - grey));
      if (x < 0) kept = std::min(kept, grey / (grey - x));
    }
    if (kept == 1) continue;
    for (double& x : c) x = grey + kept * (x - grey);
    c = space.to_xyz * c;
    std::copy(c.begin(), c.end(), v);
  }
}

}  // namespace etendue
