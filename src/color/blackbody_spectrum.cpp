#include "dense_table.h"
#include "etendue/core/error.h"
#include "etendue/describe/bands.h"
#include "named.h"
#include "planck.h"

namespace etendue {

namespace {

class BlackbodySpectrum final : public SpectralFunction {
 public:
  explicit BlackbodySpectrum(double kelvin) : kelvin_(kelvin), table_([=](double w) { return planck(w, kelvin); }) {}
  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse use) const override {
    if (in_bands(wavelengths)) [[unlikely]]
      return in_bands_.of(*this, use, wavelengths);
    return table_.evaluate(wavelengths);
  }
  float at(float wavelength, ColorUse) const override { return float(planck(double(wavelength), kelvin_)); }
  std::string expression() const override { return "blackbody(" + number_text(kelvin_) + " K)"; }

 private:
  double kelvin_;
  DenseTable table_;
  BandValues in_bands_;
};

}  // namespace

Color blackbody_spectrum(double kelvin) {
  if (!(kelvin > 0) || !(kelvin <= 1e9))
    throw Error("a black body's temperature must be above 0 K and at most 1e9 K, not " + number_text(kelvin));
  return Color(new BlackbodySpectrum(kelvin));
}

}  // namespace etendue
