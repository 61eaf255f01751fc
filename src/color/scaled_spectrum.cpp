#include <cmath>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "named.h"

namespace etendue {

namespace {

class ScaledSpectrum final : public SpectralFunction {
 public:
  ScaledSpectrum(double factor, Color base) : factor_(factor), base_(std::move(base)) {
    if (const Color k = base_->imaginary()) imaginary_ = scaled_spectrum(factor_, k);
  }
  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse use) const override {
    return float(factor_) * base_->evaluate(wavelengths, use);
  }
  float at(float wavelength, ColorUse use) const override { return float(factor_ * double(base_->at(wavelength, use))); }
  std::string expression() const override { return number_text(factor_) + " * " + base_->expression(); }
  bool varies() const override { return base_->varies(); }
  std::vector<float> corners() const override { return base_->corners(); }
  Color imaginary() const override { return imaginary_; }

  double factor() const { return factor_; }
  const Color& base() const { return base_; }

 private:
  double factor_;
  Color base_, imaginary_;
};

}  // namespace

Color scaled_spectrum(double factor, Color base) {
  if (!base) throw Error("there is no spectrum to scale");
  if (!std::isfinite(factor) || !std::isfinite(float(factor)))
    throw Error("a spectrum cannot be scaled by " + number_text(factor));
  if (factor == 1) return base;
  if (const auto* scaled = dynamic_cast<const ScaledSpectrum*>(base.get()))
    return scaled_spectrum(factor * scaled->factor(), scaled->base());
  if (!base->varies() && !base->imaginary())
    return flat_spectrum(float(factor * double(base->at(wavelength_low, ColorUse::coefficient))));
  return Color(new ScaledSpectrum(factor, std::move(base)));
}

}  // namespace etendue
