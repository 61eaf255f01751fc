#pragma once
// AlbedoInversion: from the colour of a scattering body to the coefficients of its medium.
//
// A half space of single-scattering albedo w, with the Henyey-Greenstein phase function of mean cosine g, lies under a smooth
// boundary of relative index eta. Of light that comes in diffusely (equal radiance in all directions, just below the boundary),
// the fraction C leaves again after any number of scatterings and internal reflections. C(w) has no closed form; fits such as
// that of Chiang, Kutz & Burley 2016 ("Practical and controllable subsurface scattering for production path tracing") ignore g
// and the boundary. Here C is computed, for the given g and eta, by adding and doubling (van de Hulst 1980, "Multiple light
// scattering", chapter 4; Wiscombe 1976, "On initialization, error and flux conservation in the doubling method"), and
// inverted.
//
// C is tabulated by the similarity parameter s = sqrt((1 - w) / (1 - w g)): C(s) is smooth and hardly depends on g.

#include <array>

namespace etendue {

class AlbedoInversion {
 public:
  AlbedoInversion() = default;
  /// `g` in (-1, 1); `eta` is the index inside over that outside.
  AlbedoInversion(double g, double eta);

  /// The similarity parameter of a body that returns the fraction C in [0, 1] of the light inside.
  float similarity(float returned) const;
  /// The single-scattering albedo.
  float albedo(float returned) const {
    const float s = similarity(returned);
    return (1 - s * s) / (1 - g_ * s * s);
  }

 private:
  static constexpr int intervals = 32;

  float g_ = 0;
  std::array<float, intervals + 1> returned_{};  // C at s = (i / intervals)^2: falls from 1 to 0
};

}  // namespace etendue
