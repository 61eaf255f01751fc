#pragma once
// Planck's law.

#include <cmath>

namespace etendue {

/// L = 2 h c^2 / lambda^5 / (exp(h c / (lambda k T)) - 1), per nanometre of wavelength [W m^-2 sr^-1 nm^-1], with the exact
/// constants of the SI of 2019.
inline double planck(double nanometres, double kelvin) {
  constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
  const double lambda = nanometres * 1e-9;
  return 1e-9 * 2 * h * c * c / (lambda * lambda * lambda * lambda * lambda) / std::expm1(h * c / (lambda * k * kelvin));
}

/// The maximum over wavelengths, at that of Wien's displacement law: lambda T = 2.897771955e6 nm K.
inline double highest_planck(double kelvin) { return planck(2.897771955e6 / kelvin, kelvin); }

}  // namespace etendue
