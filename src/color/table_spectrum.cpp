// Measured values, linear between, 0 outside.

#include "color/table_spectrum.h"

#include <algorithm>
#include <cmath>

#include "color/dense_table.h"
#include "color/named.h"
#include "etendue/color.h"
#include "etendue/error.h"

namespace etendue {

namespace {

/// Kept twice: as given, and resampled to 1 nm for fast evaluation. Steps finer than 1 nm are resampled by the integral
/// with a hat of 2 nm width, so that no narrow line is lost or loses power.
class TableSpectrum final : public SpectralFunction {
 public:
  TableSpectrum(std::vector<float> wavelengths, std::vector<float> values, std::string expression)
      : wavelengths_(std::move(wavelengths)), values_(std::move(values)), expression_(std::move(expression)) {
    bool fine = false;
    for (size_t i = 1; i < wavelengths_.size(); ++i) fine |= wavelengths_[i] - wavelengths_[i - 1] < 0.999f;
    dense_ = DenseTable([&](double wavelength) { return fine ? hat_mean(wavelength) : exact(wavelength); });
  }

  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse) const override { return dense_.evaluate(wavelengths); }
  float at(float wavelength, ColorUse) const override { return float(exact(double(wavelength))); }
  std::string expression() const override {
    return expression_.empty() ? table_expression(wavelengths_, values_) : expression_;
  }

 private:
  double exact(double wavelength) const {
    if (!(wavelength >= double(wavelengths_.front()) && wavelength <= double(wavelengths_.back()))) return 0;
    const auto above = std::upper_bound(wavelengths_.begin() + 1, wavelengths_.end() - 1, wavelength,
                                        [](double w, float entry) { return w < double(entry); });
    const size_t i = size_t(above - wavelengths_.begin());
    const double low = double(wavelengths_[i - 1]), high = double(wavelengths_[i]);
    const double f = (wavelength - low) / (high - low);
    return (1 - f) * double(values_[i - 1]) + f * double(values_[i]);
  }

  /// Integral of S(w) max(0, 1 - |w - centre|) dw: Simpson's rule is exact between the knots of the product.
  double hat_mean(double centre) const {
    const double low = std::max(centre - 1, double(wavelengths_.front())),
                 high = std::min(centre + 1, double(wavelengths_.back()));
    if (!(low < high)) return 0;
    std::vector<double> knots{low, high};
    if (centre > low && centre < high) knots.push_back(centre);
    const auto first = std::upper_bound(wavelengths_.begin(), wavelengths_.end(), float(low));
    for (auto w = first; w != wavelengths_.end() && double(*w) < high; ++w) knots.push_back(double(*w));
    std::sort(knots.begin(), knots.end());
    const auto product = [&](double w) { return exact(w) * std::max(0.0, 1 - std::abs(w - centre)); };
    double sum = 0;
    for (size_t i = 1; i < knots.size(); ++i) {
      const double a = knots[i - 1], b = knots[i];
      sum += (b - a) / 6 * (product(a) + 4 * product((a + b) / 2) + product(b));
    }
    return sum;
  }

  std::vector<float> wavelengths_, values_;
  std::string expression_;  // empty: the table itself
  DenseTable dense_;
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
