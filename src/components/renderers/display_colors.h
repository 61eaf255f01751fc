#pragma once
// Colours of renderers that show quantities other than light.
//
// Such colours must not depend on the wavelengths of a sample, yet the film computes each sample's XYZ from a spectrum at a few
// wavelengths. So these renderers replace the sample's wavelengths by fixed ones, chosen such that each sRGB primary is a
// non-negative sum of three of them: then every sample has exactly the intended colour.

#include <algorithm>
#include <array>

#include "etendue/describe/color.h"

namespace etendue {

/// Spectra at fixed wavelengths that are exactly colours of linear sRGB. The spectrum of (v, v, v) has Y = v.
class DisplayColors {
 public:
  Wavelengths wavelengths;

  DisplayColors() {
    // The corners of a quadrilateral of chromaticities around the sRGB gamut; no triangle of spectral colours is large enough.
    static_assert(spectrum_size >= lines);
    constexpr float nanometres[lines] = {460, 490, 535, 650};
    for (int i = 0; i < spectrum_size; ++i) wavelengths.place(i, nanometres[i % lines], 1 / (wavelength_high - wavelength_low));
    const auto& m = rgb_space("srgb").to_xyz;
    for (size_t p = 0; p < 3; ++p)
      for (int without = 0; without < lines; ++without)
        if (mix({m[p], m[3 + p], m[6 + p]}, without, primaries_[p])) break;
  }

  Spectrum operator()(const Vector3& rgb) const {
    return rgb.x * primaries_[0] + rgb.y * primaries_[1] + rgb.z * primaries_[2];
  }

 private:
  static constexpr int lines = 4;
  std::array<Spectrum, 3> primaries_;

  static double determinant(const Xyz& a, const Xyz& b, const Xyz& c) {
    return a.x * (b.y * c.z - b.z * c.y) - b.x * (a.y * c.z - a.z * c.y) + c.x * (a.y * b.z - a.z * b.y);
  }
  /// Solves for a colour as a sum of three of the spectral lines, by Cramer's rule; false if one of them would be negative.
  bool mix(const Xyz& color, int without, Spectrum& sum) const {
    std::array<int, 3> use;
    std::array<Xyz, 3> light;
    for (int line = 0, n = 0; line < lines; ++line) {
      if (line == without) continue;
      Spectrum one;
      one.set(line, 1);
      use[size_t(n)] = line;
      light[size_t(n++)] = to_xyz(one, wavelengths);
    }
    const double whole = determinant(light[0], light[1], light[2]);
    const double amounts[3] = {determinant(color, light[1], light[2]) / whole, determinant(light[0], color, light[2]) / whole,
                               determinant(light[0], light[1], color) / whole};
    sum = Spectrum();
    for (size_t i = 0; i < 3; ++i) sum.set(use[i], float(amounts[i]));
    return *std::min_element(amounts, amounts + 3) >= 0;
  }
};

inline const DisplayColors& display_colors() {
  static const DisplayColors colors;
  return colors;
}

}  // namespace etendue
