// Colours of spectra for the CIE 1931 2 degree observer.

#include <array>
#include <numeric>

#include "etendue/describe/color.h"
#include "tables.h"

namespace etendue {

namespace {

constexpr double compute_y_integral() {
  double sum = 0;
  for (const auto& row : tables::observer) sum += row[1];
  return sum;
}

}  // namespace

double observer_y_integral() {
  static const double integral = compute_y_integral();
  return integral;
}

Xyz observer(float wavelength) {
  const double x = double(wavelength) - double(wavelength_low);
  if (!(x >= 0 && x <= tables::size - 1)) return {};
  const int i = std::min(int(x), tables::size - 2);
  const double f = x - i;
  const auto& a = tables::observer[i];
  const auto& b = tables::observer[i + 1];
  return {a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1]), a[2] + f * (b[2] - a[2])};
}

Xyz to_xyz(const SpectralFunction& spectrum, ColorUse use, const SpectralFunction* illuminant) {
  Xyz sum;
  double white = 0;
  for (int first = 0; first < tables::size; first += spectrum_size) {
    Wavelengths wavelengths;
    for (int i = 0; i < spectrum_size; ++i) wavelengths.place(i, wavelength_low + float(first + i), 1);
    const Spectrum values = spectrum.evaluate(wavelengths, use);
    const Spectrum light = illuminant ? illuminant->evaluate(wavelengths, ColorUse::radiance) : Spectrum(1);
    for (int i = 0; i < spectrum_size && first + i < tables::size; ++i) {
      const auto& row = tables::observer[first + i];
      const double value = double(values[i]) * double(light[i]);
      sum += value * Xyz{row[0], row[1], row[2]};
      white += double(light[i]) * row[1];
    }
  }
  return (1 / white) * sum;
}

}  // namespace etendue
