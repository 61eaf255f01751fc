// A colour that is always evaluated for one use, whatever use is requested.

#include <fmt/format.h>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "named.h"

namespace etendue {

namespace {

constexpr const char* use_names[] = {"reflectance", "radiance", "coefficient"};  // in the order of ColorUse

class UseSpectrum final : public SpectralFunction {
 public:
  UseSpectrum(ColorUse use, Color base) : use_(use), base_(std::move(base)) {}
  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse) const override { return base_->evaluate(wavelengths, use_); }
  float at(float wavelength, ColorUse) const override { return base_->at(wavelength, use_); }
  std::string expression() const override {
    return fmt::format("read_as(\"{}\", {})", use_names[size_t(use_)], base_->expression());
  }
  std::vector<float> corners() const override { return base_->corners(); }

 private:
  ColorUse use_;
  Color base_;
};

}  // namespace

Color used_spectrum(ColorUse use, Color base) {
  if (!base) throw Error("there is no spectrum to read");
  if (base->imaginary()) throw Error("a complex index of refraction is the same for every use");
  if (!base->varies() || dynamic_cast<const UseSpectrum*>(base.get())) return base;
  return Color(new UseSpectrum(use, std::move(base)));
}

Color used_spectrum(const std::string& use, Color base) {
  const std::vector<std::string> known(std::begin(use_names), std::end(use_names));
  for (size_t i = 0; i < known.size(); ++i)
    if (use == known[i]) return used_spectrum(ColorUse(i), std::move(base));
  fail_unknown("use of a colour", use, known);
}

}  // namespace etendue
