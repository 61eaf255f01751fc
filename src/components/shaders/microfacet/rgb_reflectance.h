#pragma once
// What a metal reflects of which n and k are known for red, green and blue, and no more.

#include <array>

#include "components/shaders/fresnel.h"
#include "etendue/describe/color.h"

namespace etendue {

/// Renderers of three channels take Fresnel's reflectance of each channel for the colour of what is reflected, and that is what
/// such numbers were chosen for. So the colour becomes a spectrum, at each angle, and not the index, of which it is no linear
/// function. Which spectrum is tabulated by the cosine of the angle: to find it for a colour takes longer than all the rest of
/// a metal (7 % of a scene's time, measured on Bitterli's veach-mis).
class RgbReflectance {
 public:
  /// `n`, `k`: of red, green and blue, over the index of what is in front.
  RgbReflectance(const RgbSpace&, const Vector3& n, const Vector3& k);

  /// Those of red, green and blue, in the first places.
  const Spectrum& n() const { return n_; }
  const Spectrum& k() const { return k_; }

  Spectrum reflectance(float cosine, const Wavelengths& w) const {
    const float at = clamp(cosine, 0, 1) * cells;
    const int cell = std::min(int(at), cells - 1);
    const Node &low = nodes_[size_t(cell)], &high = nodes_[size_t(cell) + 1];
    if (low.coarse) return exact(cosine).evaluate(w);
    const float t = at - float(cell);
    return RgbCoefficients{lerp(t, low.c.c0, high.c.c0), lerp(t, low.c.c1, high.c.c1), lerp(t, low.c.c2, high.c.c2)}.evaluate(
        w);
  }
  /// Over diffuse illumination, see mean_fresnel_conductor.
  Spectrum mean_reflectance(const Wavelengths& w) const { return mean_.evaluate(w); }

  /// Of a colour that is reflected.
  RgbCoefficients spectrum_of(const Spectrum& rgb) const { return rgb_coefficients(*space_, rgb[0], rgb[1], rgb[2]); }

  /// By how much a spectrum may differ from that of the very angle, in the middle between two of the table: no more than
  /// the spectrum itself is exact to (rgb_coefficients). Where it would differ by more (near grazing angles, where all is
  /// reflected and the coefficients grow beyond all bounds) nothing is interpolated.
  static constexpr float tolerance = 2e-4f;

 private:
  static constexpr int cells = 256;
  struct Node {
    RgbCoefficients c;
    bool coarse = false;  ///< from here to the next
  };
  RgbCoefficients exact(float cosine) const { return spectrum_of(fresnel_conductor(cosine, n_, k_)); }

  const RgbSpace* space_;
  Spectrum n_, k_;
  std::array<Node, size_t(cells) + 1> nodes_;
  RgbCoefficients mean_;
};

}  // namespace etendue
