#include "spectral_bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "etendue/core/error.h"
#include "picture_format.h"

namespace etendue {
namespace {

constexpr int table_size = int(wavelength_high - wavelength_low) + 1;

/// A wavelength as the layout for spectral images writes it, with a comma as decimal mark.
std::string layout_name(double wavelength) {
  std::string number = fmt::format("{}", float(wavelength));
  std::ranges::replace(number, '.', ',');
  return "S0." + number + "nm";
}

}  // namespace

SpectralBands::Light::Light(const Spectrum& value, const Wavelengths& lambda) {
  for (int i = 0; i < spectrum_size; ++i) {
    wavelengths[size_t(i)] = double(lambda[i]);
    // A wavelength without a pdf has no weight, as in to_xyz.
    weights[size_t(i)] = lambda.pdf(i) > 0 ? double(value[i]) / (spectrum_size * double(lambda.pdf(i))) : 0;
  }
}

SpectralBands::SpectralBands(std::vector<float> edges) : edges_(std::move(edges)) {
  for (size_t b = 0; b + 1 < edges_.size(); ++b) {
    const double low = double(edges_[b]), high = double(edges_[b + 1]);
    channels_.push_back(layout_name((low + high) / 2));
    scales_.push_back(1 / (high - low));
  }
  if (std::ranges::adjacent_find(channels_) != channels_.end())
    throw Error("two bands are so narrow that the same wavelength is in the middle of both");
  const double width = (double(edges_.back()) - double(edges_.front())) / double(count());
  uniform_ = true;
  for (size_t b = 0; b < edges_.size(); ++b)
    uniform_ &= std::abs(double(edges_[b]) - (double(edges_.front()) + double(b) * width)) < 1e-3 * width;
}

SpectralBands::SpectralBands(std::vector<std::string> names, const std::vector<Color>& responses) {
  table_.resize(size_t(table_size) * responses.size());
  for (size_t b = 0; b < responses.size(); ++b) {
    channels_.push_back(response_prefix + names[b]);
    const auto at = [&](int i) { return double(responses[b]->at(wavelength_low + float(i), ColorUse::coefficient)); };
    double integral = 0;  // exact for a table that is linear between whole nanometres
    for (int i = 0; i < table_size; ++i) integral += (i == 0 || i + 1 == table_size ? 0.5 : 1) * at(i);
    if (!(integral > 0) || !std::isfinite(integral))
      throw Error(
          fmt::format("the response '{}' has no sensitivity between {} and {} nm", names[b], wavelength_low, wavelength_high));
    scales_.push_back(1 / integral);
    for (int i = 0; i < table_size; ++i) table_[size_t(i) * responses.size() + b] = float(at(i) / integral);
  }
}

std::string SpectralBands::key() const {
  std::string key;
  for (const float edge : edges_) key += fmt::format("{} ", edge);
  for (const std::string& name : channels_) key += name + " ";
  for (const float r : table_) key += fmt::format("{} ", r);
  return key;
}

void SpectralBands::measure(const Light& light, std::vector<Value>& values) const {
  values.clear();
  if (table_.empty())
    measure_boxes(light, values);
  else
    measure_responses(light, values);
}

// Bands contain their lower edge and, the last one only, the upper one.
void SpectralBands::measure_boxes(const Light& light, std::vector<Value>& values) const {
  const double low = double(edges_.front()), high = double(edges_.back()), last = double(count() - 1);
  for (size_t i = 0; i < spectrum_size; ++i) {
    const double lambda = light.wavelengths[i];
    if (light.weights[i] == 0 || !(lambda >= low && lambda <= high)) continue;
    size_t band = 0;
    if (uniform_) {
      band = size_t(std::min((lambda - low) / (high - low) * double(count()), last));
      // The division is rounded, the edges decide.
      while (band > 0 && lambda < double(edges_[band])) --band;
      while (band + 1 < count() && lambda >= double(edges_[band + 1])) ++band;
    } else {
      const auto above = std::upper_bound(edges_.begin(), edges_.end(), float(lambda));
      band = size_t(std::min(double(above - edges_.begin()) - 1, last));
    }
    values.push_back({band, light.weights[i] * scales_[band]});
  }
}

void SpectralBands::measure_responses(const Light& light, std::vector<Value>& values) const {
  const size_t n = count();
  values.resize(n);
  for (size_t b = 0; b < n; ++b) values[b] = {b, 0};
  for (size_t i = 0; i < spectrum_size; ++i) {
    const double x = light.wavelengths[i] - double(wavelength_low);
    if (light.weights[i] == 0 || !(x >= 0 && x <= table_size - 1)) continue;
    const auto row = size_t(std::min(int(x), table_size - 2));
    const double f = x - double(row);
    const float* r = &table_[row * n];
    for (size_t b = 0; b < n; ++b) values[b].value += light.weights[i] * ((1 - f) * double(r[b]) + f * double(r[n + b]));
  }
}

}  // namespace etendue
