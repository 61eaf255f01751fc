// The minimum and maximum of a spectrum.

#include "etendue/core/spectral_function.h"

namespace etendue {

ValueRange range_of(const SpectralFunction& f, ColorUse use) {
  ValueRange r;
  r.least = r.most = f.at(wavelength_low, use);
  r.least_at = r.most_at = wavelength_low;
  const auto look = [&](float wavelength) {
    if (!(wavelength >= wavelength_low && wavelength <= wavelength_high)) return;
    const float value = f.at(wavelength, use);
    // The comparison is true for NaN, which thus becomes the minimum.
    if (!(value >= r.least)) r.least = value, r.least_at = wavelength;
    if (value > r.most) r.most = value, r.most_at = wavelength;
  };
  if (f.varies())
    for (float wavelength = wavelength_low; wavelength <= wavelength_high; wavelength += 1) look(wavelength);
  for (const float wavelength : f.corners()) look(wavelength);
  return r;
}

}  // namespace etendue
