#pragma once
// Radiant and luminous quantities in which the amount of emitted light can be given.

#include "etendue/describe/color.h"

namespace etendue {

/// A quantity of an object's whole emission (power, flux), or of its emission along its axis (intensity, illuminance).
enum class Quantity : std::uint8_t {
  power,       ///< [W] between 360 and 830 nm
  flux,        ///< luminous flux [lm]
  intensity,   ///< luminous intensity [cd]
  illuminance  ///< [lx]
};

/// K_m, the greatest luminous efficacy of radiation: 683 lm/W at 540 THz (the SI's definition of the candela), hence 683.002 at
/// 555 nm, where V = 1 (CIE 18.2; BIPM 2019).
inline constexpr double luminous_efficacy = 683.002;  // [lm/W]

/// The weight of a watt at a wavelength: 1 W, or K_m V(lambda) lm, as V is the observer's ybar.
inline double weight(Quantity quantity, float wavelength) {
  return quantity == Quantity::power ? 1 : luminous_efficacy * observer(wavelength).y;
}

/// The weighted integral of a spectral radiance over wavelengths, by the trapezoid rule with steps of 1 nm, as tabulated
/// spectra are linear between these.
template <class F>
double integrate_spectrum(Quantity quantity, const F& value_at) {
  double sum = 0;
  for (float lambda = wavelength_low; lambda <= wavelength_high; lambda += 1) {
    const double value = double(value_at(lambda)) * weight(quantity, lambda);
    sum += lambda == wavelength_low || lambda == wavelength_high ? value / 2 : value;
  }
  return sum;
}

/// The same for a function that is evaluated at a path's Wavelengths: the midpoint rule with 48 equal steps.
template <class F>
double integrate_wavelengths(Quantity quantity, const F& spectrum_at) {
  constexpr int sets = 48 / spectrum_size;
  constexpr float range = wavelength_high - wavelength_low, step = range / (sets * spectrum_size);
  double sum = 0;
  for (int set = 0; set < sets; ++set) {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, wavelength_low + (float(i * sets + set) + 0.5f) * step, 1 / range);
    const Spectrum s = spectrum_at(w);
    for (int i = 0; i < spectrum_size; ++i) sum += double(s[i]) * weight(quantity, w[i]) * double(step);
  }
  return sum;
}

}  // namespace etendue
