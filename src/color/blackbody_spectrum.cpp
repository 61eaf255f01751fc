#include <cmath>

#include "dense_table.h"
#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "named.h"

namespace etendue {

namespace {

/// Planck's law, L = 2 h c^2 / lambda^5 / (exp(h c / (lambda k T)) - 1), per nanometre of wavelength
/// [W m^-2 sr^-1 nm^-1], with the exact constants of the SI of 2019.
double planck(double nanometres, double kelvin) {
  constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
  const double lambda = nanometres * 1e-9;
  return 1e-9 * 2 * h * c * c / (lambda * lambda * lambda * lambda * lambda) / std::expm1(h * c / (lambda * k * kelvin));
}

class BlackbodySpectrum final : public SpectralFunction {
 public:
  explicit BlackbodySpectrum(double kelvin) : kelvin_(kelvin), table_([=](double w) { return planck(w, kelvin); }) {}
  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse) const override { return table_.evaluate(wavelengths); }
  float at(float wavelength, ColorUse) const override { return float(planck(double(wavelength), kelvin_)); }
  std::string expression() const override { return "blackbody(" + number_text(kelvin_) + " K)"; }

 private:
  double kelvin_;
  DenseTable table_;
};

}  // namespace

Color blackbody_spectrum(double kelvin) {
  if (!(kelvin > 0) || !(kelvin <= 1e9))
    throw Error("a black body's temperature must be above 0 K and at most 1e9 K, not " + number_text(kelvin));
  return Color(new BlackbodySpectrum(kelvin));
}

}  // namespace etendue
