#include <cmath>

#include "etendue/describe/bands.h"
#include "named.h"
#include "tables.h"

namespace etendue {

namespace {

/// Sellmeier's formula, n^2 = 1 + sum_i B_i L^2 / (L^2 - C_i), with each term written as B_i + B_i C_i / (L^2 - C_i):
/// B_i C_i is small, so float arithmetic keeps n to its last digit or two.
class GlassIndex final : public SpectralFunction {
 public:
  explicit GlassIndex(const tables::Glass& glass) : glass_(glass) {
    double constant = 1;
    for (int i = 0; i < 4; ++i) {
      // A resonance at 0 makes the term constant; a term with B = 0 vanishes.
      constant += glass.b[i];
      product_[i] = float(glass.b[i] * glass.c[i]);
      resonance_[i] = float(glass.c[i]);
    }
    constant_ = float(constant);
  }

  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse use) const override {
    if (in_bands(wavelengths)) [[unlikely]]
      return in_bands_.of(*this, use, wavelengths);
    detail::Lanes result{};
    for (int i = 0; i < spectrum_size; ++i) {
      const float micrometres = wavelengths[i] * 1e-3f, square = micrometres * micrometres;
      float sum = constant_;
      for (int j = 0; j < 4; ++j) sum += product_[j] / (square - resonance_[j]);
      result[i] = std::sqrt(sum);
    }
    return Spectrum(result);
  }
  float at(float wavelength, ColorUse) const override {
    const double square = 1e-6 * double(wavelength) * double(wavelength);
    double sum = 1;
    for (int i = 0; i < 4; ++i) sum += glass_.b[i] * square / (square - glass_.c[i]);
    return float(std::sqrt(sum));
  }
  std::string expression() const override { return "glass(" + quoted(glass_.name) + ")"; }

 private:
  const tables::Glass& glass_;
  float constant_, product_[4], resonance_[4];  // micrometres squared
  BandValues in_bands_;
};

}  // namespace

Color glass_index(const std::string& name) { return Color(new GlassIndex(find_named(tables::glasses, "glass", name))); }

std::vector<std::string> glass_names() { return names_of(tables::glasses); }

}  // namespace etendue
