#include "rgb_reflectance.h"

namespace etendue {

RgbReflectance::RgbReflectance(const RgbSpace& space, const Vector3& n, const Vector3& k) : space_(&space) {
  for (int i = 0; i < spectrum_size; ++i) {
    n_.set(i, n[std::min(i, 2)]);
    k_.set(i, k[std::min(i, 2)]);
  }
  mean_ = spectrum_of(mean_fresnel_conductor(n_, k_));

  for (int i = 0; i <= cells; ++i) nodes_[size_t(i)] = {exact(float(i) / cells), false};
  // Spectra are smooth (sigmoids of parabolas): checking a few wavelengths is enough.
  Wavelengths w;
  for (int i = 0; i < spectrum_size; ++i)
    w.place(i, wavelength_low + (wavelength_high - wavelength_low) * (float(i) + 0.5f) / spectrum_size, 1);
  for (int i = 0; i < cells; ++i) {
    const float middle = (float(i) + 0.5f) / cells;
    const Spectrum wanted = exact(middle).evaluate(w), found = reflectance(middle, w);
    for (int l = 0; l < spectrum_size; ++l) nodes_[size_t(i)].coarse |= !(std::abs(found[l] - wanted[l]) <= tolerance);
  }
}

}  // namespace etendue
