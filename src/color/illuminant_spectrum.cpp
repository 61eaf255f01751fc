#include "etendue/describe/bands.h"
#include "named.h"
#include "stepped_table.h"
#include "tables.h"

namespace etendue {

namespace {

/// A tabulated illuminant, 0 outside its table, scaled so that the 1 nm sum over 360-830 nm gives Y = 1.
class IlluminantSpectrum final : public SpectralFunction {
 public:
  explicit IlluminantSpectrum(const tables::Illuminant& data) : name_(data.name) {
    std::vector<float> wavelengths, values;
    for (size_t i = 0; i < data.power.size(); ++i) {
      wavelengths.push_back(float(data.low + data.step * double(i)));
      values.push_back(float(data.power[i]));
    }
    const SteppedTable relative(wavelengths, values);
    double y = 0;
    for (int i = 0; i < tables::size; ++i) y += tables::observer[i][1] * relative.exact(double(wavelength_low) + i);
    for (float& value : values) value = float(double(value) * (observer_y_integral() / y));
    table_ = SteppedTable(std::move(wavelengths), std::move(values));
  }
  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse use) const override {
    if (in_bands(wavelengths)) [[unlikely]]
      return in_bands_.of(*this, use, wavelengths);
    return table_.evaluate(wavelengths);
  }
  float at(float wavelength, ColorUse) const override { return float(table_.exact(double(wavelength))); }
  std::vector<float> corners() const override { return table_.corners(); }
  std::string expression() const override { return "illuminant(" + quoted(name_) + ")"; }

 private:
  std::string name_;
  SteppedTable table_;
  BandValues in_bands_;
};

}  // namespace

Color illuminant_spectrum(const std::string& name) {
  return Color(new IlluminantSpectrum(find_named(tables::illuminants, "illuminant", name)));
}

std::vector<std::string> illuminant_names() { return names_of(tables::illuminants); }

}  // namespace etendue
