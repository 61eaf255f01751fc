#include "stepped_table.h"

#include <algorithm>
#include <limits>

namespace etendue {

SteppedTable::SteppedTable(std::vector<float> wavelengths, std::vector<float> values)
    : wavelengths_(std::move(wavelengths)), values_(std::move(values)) {
  dense_ = DenseTable([this](double wavelength) { return exact(wavelength); });
  find_bent_cells();
}

double SteppedTable::exact(double wavelength) const {
  if (!(wavelength >= double(wavelengths_.front()) && wavelength <= double(wavelengths_.back()))) return 0;
  const auto above = std::upper_bound(wavelengths_.begin() + 1, wavelengths_.end() - 1, wavelength,
                                      [](double w, float entry) { return w < double(entry); });
  const size_t i = size_t(above - wavelengths_.begin());
  const double begin = double(wavelengths_[i - 1]), end = double(wavelengths_[i]);
  const double f = (wavelength - begin) / (end - begin);
  return (1 - f) * double(values_[i - 1]) + f * double(values_[i]);
}

void SteppedTable::correct(const Wavelengths& w, Spectrum& s) const {
  for (int i = 0; i < spectrum_size; ++i)
    if (s[i] != s[i]) s.set(i, in_cell(w.table_index(i), w[i]));
}

float SteppedTable::in_cell(int cell, float wavelength) const {
  size_t i = first_[size_t(cell)];
  const size_t end = first_[size_t(cell) + 1];
  constexpr size_t few = 8;
  if (end - i > few)
    i = size_t(
        std::upper_bound(wavelengths_.begin() + std::ptrdiff_t(i), wavelengths_.begin() + std::ptrdiff_t(end), wavelength) -
        wavelengths_.begin());
  else
    while (i < end && wavelengths_[i] <= wavelength) ++i;
  if (i == 0) return 0;
  if (i == wavelengths_.size()) return wavelength == wavelengths_.back() ? values_.back() : 0.0f;
  return values_[i - 1] + (wavelength - wavelengths_[i - 1]) * slopes_[i - 1];
}

void SteppedTable::find_bent_cells() {
  // Deviations below this fraction of the values are ignored: they come from kinks of smooth data at fractional wavelengths.
  constexpr double tolerance = 1e-3;
  std::array<bool, size_t(cells)> bent{};
  const size_t last = wavelengths_.size() - 1;
  for (size_t i = 0; i <= last; ++i) {
    const double x = double(wavelengths_[i]) - double(wavelength_low), value = double(values_[i]);
    if (!(x >= 0 && x <= cells)) continue;
    const int cell = std::min(int(x), cells - 1);
    const double low = double(dense_.entry(cell)), high = double(dense_.entry(cell + 1)), f = x - cell;
    const double dense = (1 - f) * low + f * high;
    if (std::abs(dense - value) > tolerance * std::max({std::abs(low), std::abs(high), std::abs(value)}))
      bent[size_t(cell)] = true;
    // Outside of the table the value is 0; a cell at the end of the table must not interpolate towards it.
    const bool whole = x == std::floor(x);
    if (i == 0 && value != 0 && (!whole || x > 0)) bent[size_t(whole ? int(x) - 1 : cell)] = true;
    if (i == last && value != 0 && x < cells) bent[size_t(int(x))] = true;
  }
  bent_cells_ = int(std::count(bent.begin(), bent.end(), true));
  any_bent_ = bent_cells_ > 0;
  if (!any_bent_) return;
  for (int c = 0; c < cells; ++c)
    if (bent[size_t(c)]) dense_.set_entry(c, std::numeric_limits<float>::quiet_NaN());
  for (size_t i = 0; i < last; ++i) slopes_.push_back((values_[i + 1] - values_[i]) / (wavelengths_[i + 1] - wavelengths_[i]));
  for (int c = 0; c <= cells; ++c)
    first_.push_back(std::uint32_t(std::upper_bound(wavelengths_.begin(), wavelengths_.end(), wavelength_low + float(c)) -
                                   wavelengths_.begin()));
}

// Simpson's rule is exact between the knots of the product, which is piecewise quadratic.
double SteppedTable::hat_mean(double centre) const {
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

std::vector<float> SteppedTable::corners() const {
  std::vector<float> list;
  for (const float w : wavelengths_)
    if (w != std::floor(w)) list.push_back(w);
  return list;
}

}  // namespace etendue
