#include "etendue/describe/bands.h"
#include "named.h"

namespace etendue {

namespace {

class FlatSpectrum final : public SpectralFunction {
 public:
  explicit FlatSpectrum(float value) : value_(value) {}
  Spectrum evaluate(const Wavelengths& w, ColorUse use) const override { return used_number(value_, use, w); }
  float at(float, ColorUse) const override { return value_; }
  std::string expression() const override { return number_text(value_); }
  bool varies() const override { return false; }

 private:
  float value_;
};

}  // namespace

Color flat_spectrum(float value) { return Color(new FlatSpectrum(value)); }

}  // namespace etendue
