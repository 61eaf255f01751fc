#pragma once
// Integrals of a sensor's sensitivities over the wavelength.

#include <algorithm>
#include <cmath>

#include "etendue/core/spectral_function.h"
#include "sensor.h"

namespace etendue {

/// The integral of a function of the wavelength over an interval [nm], by midpoints.
template <class F>
double integral(double low, double high, const F& f) {
  const int steps = std::max(1, int(std::ceil((high - low) / 0.25)));
  const double step = (high - low) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(low + (i + 0.5) * step);
  return sum * step;
}

template <class F>
double whole_integral(const F& f) {
  return integral(double(wavelength_low), double(wavelength_high), f);
}

inline double value_at(const SpectralFunction& f, double wavelength, ColorUse use) {
  return double(f.at(float(wavelength), use));
}
inline double sensitivity(const Sensor& sensor, size_t channel, double wavelength) {
  return value_at(*sensor.sensitivities[channel], wavelength, ColorUse::coefficient);
}

}  // namespace etendue
