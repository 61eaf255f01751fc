#pragma once
// RgbReflectance: the spectral reflectance of a metal whose n and k are given for red, green and blue only.

#include <array>

#include "components/shaders/fresnel.h"
#include "etendue/describe/bands.h"

namespace etendue {

/// RGB renderers use the Fresnel reflectance of each channel as the colour of the reflected light, and such n and k are chosen
/// for that. So the reflected colour is converted to a spectrum, at each angle; n and k are not, because reflectance is not
/// linear in them. The spectrum's coefficients are tabulated by the cosine of the angle: computing them for a colour takes
/// longer than all the rest of a metal (7 % of a scene's time, measured on Bitterli's veach-mis).
class RgbReflectance {
 public:
  /// `n`, `k`: of red, green and blue, over the index of the medium in front.
  RgbReflectance(const RgbSpace&, const Vector3& n, const Vector3& k);

  /// n and k of red, green and blue, in the first three elements.
  const Spectrum& n() const { return n_; }
  const Spectrum& k() const { return k_; }

  Spectrum reflectance(float cosine, const Wavelengths& w) const {
    if (in_bands(w)) return seen(fresnel_conductor(cosine, n_, k_), w);
    const float at = clamp(cosine, 0, 1) * cells;
    const int cell = std::min(int(at), cells - 1);
    const Node &low = nodes_[size_t(cell)], &high = nodes_[size_t(cell) + 1];
    if (low.coarse) return exact(cosine).evaluate(w);
    const float t = at - float(cell);
    return RgbCoefficients{lerp(t, low.c.c0, high.c.c0), lerp(t, low.c.c1, high.c.c1), lerp(t, low.c.c2, high.c.c2)}.evaluate(
        w);
  }
  /// The mean reflectance over diffuse illumination, see mean_fresnel_conductor.
  Spectrum mean_reflectance(const Wavelengths& w) const {
    return in_bands(w) ? seen(mean_fresnel_conductor(n_, k_), w) : mean_.evaluate(w);
  }

  /// The spectrum of a reflected colour, of which the first three elements are red, green and blue.
  Spectrum seen(const Spectrum& rgb, const Wavelengths& w) const {
    return rgb_spectrum(*space_, rgb[0], rgb[1], rgb[2], ColorUse::reflectance, w);
  }

  /// The greatest accepted difference between interpolated and exact spectrum, midway between two entries of the table: the
  /// precision of the spectrum itself (rgb_coefficients). Intervals with a greater difference are not interpolated but computed
  /// exactly (near grazing angles, where everything is reflected and the coefficients diverge).
  static constexpr float tolerance = 2e-4f;

 private:
  static constexpr int cells = 256;
  struct Node {
    RgbCoefficients c;
    bool coarse = false;  ///< the interval from here to the next is not interpolated
  };
  RgbCoefficients spectrum_of(const Spectrum& rgb) const { return rgb_coefficients(*space_, rgb[0], rgb[1], rgb[2]); }
  RgbCoefficients exact(float cosine) const { return spectrum_of(fresnel_conductor(cosine, n_, k_)); }

  const RgbSpace* space_;
  Spectrum n_, k_;
  std::array<Node, size_t(cells) + 1> nodes_;
  RgbCoefficients mean_;
};

}  // namespace etendue
