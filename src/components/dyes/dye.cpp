// Dye, and the tables that it and other fluorescence are made of.

#include "etendue/dye.h"

#include <fmt/format.h>

#include <algorithm>

namespace etendue {

SampledFunction::SampledFunction(const std::array<float, size>& values) : values_(values) {
  double sum = 0;
  std::array<double, size> sums{};
  for (int k = 0; k + 1 < size; ++k) {
    sum += 0.5 * (double(values_[size_t(k)]) + double(values_[size_t(k) + 1]));
    sums[size_t(k) + 1] = sum;
  }
  integral_ = float(sum);
  if (!(sum > 0)) return;
  for (int k = 0; k < size; ++k) cdf_[size_t(k)] = float(sums[size_t(k)] / sum);
}

float SampledFunction::operator()(float wavelength) const {
  const float x = wavelength - wavelength_low;
  if (!(x >= 0 && x <= wavelength_high - wavelength_low)) return 0;
  const int k = std::min(int(x), size - 2);
  const float t = x - float(k);
  return values_[size_t(k)] * (1 - t) + values_[size_t(k) + 1] * t;
}

float SampledFunction::largest() const { return *std::ranges::max_element(values_); }

// The pdf is constant within each nanometre, so a value that is not 0 anywhere in one has a pdf that is not 0 either.
float SampledFunction::sample(float u, float& pdf) const {
  const auto above = std::upper_bound(cdf_.begin(), cdf_.end(), u);
  size_t k = size_t(std::max<std::ptrdiff_t>(above - cdf_.begin() - 1, 0));
  k = std::min(k, size_t(size) - 2);
  while (k > 0 && !(cdf_[k + 1] > cdf_[k])) --k;  // u beyond the last value that is not 0, by rounding
  pdf = cdf_[k + 1] - cdf_[k];
  const float within = pdf > 0 ? clamp((u - cdf_[k]) / pdf, 0, 1) : 0.5f;
  return wavelength_low + float(k) + within;
}

void Dye::describe(Description<Dye>& d) {
  d.summary(
       "A fluorescent dye: it absorbs light and emits a part of it at other wavelengths. Light outside of 360 to 830 nm is not "
       "computed, so that what excites it must lie within.",
       "Donaldson 1954; Valeur & Berberan-Santos 2012, Molecular Fluorescence")
      .group("Fluorescence")
      .member<&Dye::absorption_spectrum>("absorption", "1",
                                         "how strongly it absorbs (its excitation spectrum), in any unit: the largest value "
                                         "counts as 1",
                                         Meaning::coefficient)
      .member<&Dye::emission>("emission", "1", "the power that it emits, per nanometre, in any unit", Meaning::coefficient)
      .member<&Dye::quantum_yield>("quantum_yield", "1", "photons emitted for each that is absorbed", range(0, 1));
}

namespace {

std::array<float, SampledFunction::size> tabulated(const Dye& dye, const char* member, const Color& color) {
  if (!color) dye.fail(member, "a spectrum is needed");
  if (color->imaginary()) dye.fail(member, "must be real; this is a complex index of refraction");
  std::array<float, SampledFunction::size> values{};
  float most = 0;
  for (int k = 0; k < SampledFunction::size; ++k) {
    const float value = color->at(wavelength_low + float(k), ColorUse::coefficient);
    if (!(value >= 0 && value < infinity))
      dye.fail(member,
               fmt::format("must be neither negative nor infinite, and is {} at {} nm", value, wavelength_low + float(k)));
    values[size_t(k)] = value;
    most = std::max(most, value);
  }
  if (!(most > 0)) dye.fail(member, "is 0 at all wavelengths from 360 to 830 nm, which are those that are computed");
  for (float& value : values) value /= most;
  return values;
}

}  // namespace

void Dye::prepare() {
  const auto x = tabulated(*this, "absorption", absorption_spectrum);
  auto e = tabulated(*this, "emission", emission);
  absorption_ = SampledFunction(x);
  // The integrals of the products of two functions that are linear between the same points, by Simpson's rule, which is exact.
  const auto moment = [](const std::array<float, SampledFunction::size>& f) {
    double sum = 0;
    for (int k = 0; k + 1 < SampledFunction::size; ++k) {
      const double a = double(f[size_t(k)]), b = double(f[size_t(k) + 1]), l = double(wavelength_low) + k;
      sum += (a * l + 2 * (a + b) * (l + 0.5) + b * (l + 1)) / 6;
    }
    return sum;
  };
  received_ = float(moment(x));
  const double photons = moment(e);
  for (float& value : e) value = float(double(quantum_yield) * double(value) / photons);
  yield_ = SampledFunction(e);
}

static const Register<Dye> registered;

}  // namespace etendue
