// Measured values, linearly interpolated, 0 outside.

#include "table_spectrum.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "etendue/core/error.h"
#include "etendue/describe/bands.h"
#include "named.h"
#include "stepped_table.h"

namespace etendue {

namespace {

// For reflectances, absorption and refractive indices the table's values are used exactly, steps included, because radiance
// depends on them by powers and exponentials. Emission spectra may have lines far narrower than a nanometre, which sampled
// wavelengths would hardly ever hit. So the emission of a table that has such lines, or that has kinks inside many cells of a
// nanometre, is averaged over a triangular slit function of 2 nm width, which neither misses a line nor changes its power.
class TableSpectrum final : public SpectralFunction {
 public:
  TableSpectrum(std::vector<float> wavelengths, std::vector<float> values, std::string expression)
      : table_(std::move(wavelengths), std::move(values)), expression_(std::move(expression)) {
    if (!fine()) return;
    constexpr int many = tables::size / 4;
    auto light = std::make_unique<DenseTable>([this](double wavelength) { return table_.hat_mean(wavelength); });
    if (table_.bent_cells() > many || has_lines(*light)) light_ = std::move(light);
  }

  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse use) const override {
    if (in_bands(wavelengths)) [[unlikely]]
      return in_bands_.of(*this, use, wavelengths);
    return light_ && use == ColorUse::radiance ? light_->evaluate(wavelengths) : table_.evaluate(wavelengths);
  }
  float at(float wavelength, ColorUse use) const override {
    return light_ && use == ColorUse::radiance ? light_->at(wavelength) : float(table_.exact(double(wavelength)));
  }
  std::vector<float> corners() const override { return table_.corners(); }
  std::string expression() const override {
    return expression_.empty() ? table_expression(table_.wavelengths(), table_.values()) : expression_;
  }

 private:
  bool fine() const {
    const std::vector<float>& w = table_.wavelengths();
    for (size_t i = 1; i < w.size(); ++i)
      if (w[i] - w[i - 1] < 0.999f) return true;
    return false;
  }
  /// Whether the table has peaks narrower than about a quarter of a nanometre.
  bool has_lines(const DenseTable& mean) const {
    const std::vector<float>& w = table_.wavelengths();
    for (size_t i = 0; i < w.size(); ++i) {
      const float k = std::floor(w[i]);
      if (table_.values()[i] > 4 * std::max(mean.at(k), mean.at(k + 1))) return true;
    }
    return false;
  }

  SteppedTable table_;
  std::string expression_;             // empty: a literal of the table
  std::unique_ptr<DenseTable> light_;  // of a table with lines: the averaged emission
  BandValues in_bands_;
};

}  // namespace

std::string table_expression(const std::vector<float>& wavelengths, const std::vector<float>& values) {
  const auto list = [](const std::vector<float>& numbers) {
    std::string text;
    for (const float x : numbers) text += (text.empty() ? "" : ", ") + number_text(x);
    return "[" + text + "]";
  };
  return "spectrum(" + list(wavelengths) + ", " + list(values) + ")";
}

Color make_table_spectrum(std::vector<float> wavelengths, std::vector<float> values, std::string expression) {
  if (wavelengths.size() != values.size())
    throw Error("a spectrum needs as many values as wavelengths, not " + std::to_string(values.size()) + " for " +
                std::to_string(wavelengths.size()));
  if (wavelengths.size() < 2) throw Error("a spectrum needs at least two wavelengths");
  for (size_t i = 0; i < wavelengths.size(); ++i) {
    if (!std::isfinite(wavelengths[i]) || !std::isfinite(values[i]))
      throw Error("entry " + std::to_string(i + 1) + " of a spectrum is not a finite number");
    if (i > 0 && !(wavelengths[i] > wavelengths[i - 1]))
      throw Error("the wavelengths of a spectrum must increase: " + number_text(wavelengths[i]) + " follows " +
                  number_text(wavelengths[i - 1]));
  }
  if (wavelengths.back() < 10) throw Error("wavelengths are expected in nm; these, all below 10, seem to be in micrometres");
  return Color(new TableSpectrum(std::move(wavelengths), std::move(values), std::move(expression)));
}

Color table_spectrum(std::vector<float> wavelengths, std::vector<float> values) {
  return make_table_spectrum(std::move(wavelengths), std::move(values), {});
}

}  // namespace etendue
