#pragma once
// Bands: the red, green and blue of an RGB space in place of wavelengths, for paths that compute three colours
// (RgbWavelengths).

#include <atomic>

#include "etendue/describe/color.h"

namespace etendue {

// A path in bands carries the components of colours in one RGB space: of radiance, its RGB, of which (1, 1, 1) is the space's
// white with Y = 1; of a reflectance or a coefficient, the factors of these. Products of colours are products of components.
//
// Lane i of its spectra is band i mod 3. No lane is empty, so that the means and maxima over lanes from which probabilities
// follow are those of colours. Its Wavelengths hold no wavelengths but a mark that names the space, -1 - its number.

/// The Wavelengths of a path in the bands of a space. Throws Error unless rgb_space() returned it.
Wavelengths bands_of(const RgbSpace&);
inline bool in_bands(const Wavelengths& w) { return w.hero() < 0; }
const RgbSpace& space_of_bands(const Wavelengths&);

/// Three values, one for each band.
inline Spectrum band_spectrum(float red, float green, float blue) {
  const float values[3] = {red, green, blue};
  Spectrum s;
  for (int i = 0; i < spectrum_size; ++i) s.set(i, values[i % 3]);
  return s;
}

/// An RGB colour in bands. In the bands' own space its components are taken as they are, a reflectance's within [0, 1].
/// Radiance of another space has the same X Y Z. Reflectances and coefficients of a space with another white look the same
/// under the bands' white (Bradford's adaptation; Lam 1985). What is negative then counts as 0.
Spectrum rgb_in_bands(const RgbSpace&, float r, float g, float b, ColorUse, const Wavelengths& bands);

/// The radiance in bands of a spectrum that is 1 at every wavelength.
Spectrum equal_energy_in_bands(const Wavelengths& bands);

/// A number as a colour: light of that radiance at every wavelength is not that of the bands' white.
inline Spectrum used_number(float value, ColorUse use, const Wavelengths& w) {
  return use == ColorUse::radiance && in_bands(w) ? value * equal_energy_in_bands(w) : Spectrum(value);
}

/// A colour in bands from X Y Z: radiance's own, or that of the light of the bands' white that a reflectance reflects, relative
/// to a perfect white. Negative components count as 0.
Spectrum xyz_in_bands(const Xyz&, ColorUse, const Wavelengths& bands);

/// The values in bands of a spectrum given by a function of the wavelength [nm]: its colour as light, or in the light of the
/// bands' white. By the midpoint rule with steps of 5 nm, for smooth functions that are not known before.
template <class F>
Spectrum projected(const F& value, ColorUse use, const Wavelengths& bands) {
  constexpr float step = 5;
  const SpectralFunction* const white = use == ColorUse::radiance ? nullptr : space_of_bands(bands).illuminant.get();
  Xyz sum;
  double whole = 0;
  for (float w = wavelength_low + step / 2; w < wavelength_high; w += step) {
    const Xyz seen = double(white ? white->at(w, ColorUse::radiance) : 1) * observer(w);
    whole += seen.y;
    sum += double(value(w)) * seen;
  }
  return xyz_in_bands((1 / whole) * sum, use, bands);
}

/// The values of one spectrum in bands, computed when they are first needed. Thread-safe.
class BandValues {
 public:
  BandValues() = default;
  ~BandValues();
  BandValues(const BandValues&) = delete;
  BandValues& operator=(const BandValues&) = delete;

  /// Of a spectrum that is always the same. Components that would be negative, or of a reflectance above 1, are told in a
  /// warning.
  Spectrum of(const SpectralFunction&, ColorUse, const Wavelengths& bands) const;

 private:
  struct Entry {
    const RgbSpace* space;
    ColorUse use;
    Spectrum values;
    const Entry* next;
  };
  mutable std::atomic<const Entry*> first_{nullptr};
};

/// A second base class of components whose light depends on wavelengths in a way that three bands do not have: interference,
/// dispersion, measured spectra.
class NeedsWavelengths {
 public:
  virtual ~NeedsWavelengths() = default;
  /// Throws an Error at the member that needs wavelengths, if one does as it is set. Called when the component is prepared.
  virtual void refuse_bands() const = 0;
};

}  // namespace etendue
