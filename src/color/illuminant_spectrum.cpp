#include "color/dense_table.h"
#include "color/named.h"
#include "color/tables.h"
#include "etendue/color.h"

namespace etendue {

namespace {

/// A tabulated illuminant, 0 outside its table, scaled so that the 1 nm sum over 360-830 nm gives Y = 1.
class IlluminantSpectrum final : public SpectralFunction {
 public:
  explicit IlluminantSpectrum(const tables::Illuminant& data) : name_(data.name) {
    const auto power = [&](double wavelength) {
      const double x = (wavelength - data.low) / data.step;
      const double last = double(data.power.size() - 1);
      if (!(x >= 0 && x <= last)) return 0.0;
      const size_t i = std::min(size_t(x), data.power.size() - 2);
      return data.power[i] + (x - double(i)) * (data.power[i + 1] - data.power[i]);
    };
    double y = 0;
    for (int i = 0; i < tables::size; ++i) y += tables::observer[i][1] * power(double(wavelength_low) + i);
    table_ = DenseTable([&](double wavelength) { return power(wavelength) * (observer_y_integral() / y); });
  }
  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse) const override { return table_.evaluate(wavelengths); }
  float at(float wavelength, ColorUse) const override { return table_.at(wavelength); }
  std::string expression() const override { return "illuminant(" + quoted(name_) + ")"; }

 private:
  std::string name_;
  DenseTable table_;
};

}  // namespace

Color illuminant_spectrum(const std::string& name) {
  return Color(new IlluminantSpectrum(find_named(tables::illuminants, "illuminant", name)));
}

std::vector<std::string> illuminant_names() { return names_of(tables::illuminants); }

}  // namespace etendue
