#include "donaldson_matrix.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "etendue/core/error.h"
#include "files/regular_file.h"

namespace etendue {
namespace {

/// A function that is linear between equally spaced values, as a table of each nanometre; 0 outside.
SampledFunction table_of(const std::vector<double>& values, float first, float step) {
  std::array<float, SampledFunction::size> table{};
  for (int k = 0; k < SampledFunction::size; ++k) {
    const double x = (double(wavelength_low) + k - double(first)) / double(step);
    if (!(x >= 0 && x <= double(values.size() - 1))) continue;
    const size_t i = std::min(size_t(x), values.size() - 2);
    const double t = x - double(i);
    table[size_t(k)] = float(values[i] * (1 - t) + values[i + 1] * t);
  }
  return SampledFunction(table);
}

std::optional<float> number_of(std::string_view text) {
  float value = 0;
  const size_t first = text.find_first_not_of(" \t\r\"");
  if (first == text.npos) return {};
  text = text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
  if (text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  const char separator = line.find(';') != line.npos ? ';' : line.find('\t') != line.npos ? '\t' : ',';
  std::vector<std::string_view> fields;
  for (size_t begin = 0; begin <= line.size();) {
    const size_t end = std::min(line.find(separator, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return fields;
}

}  // namespace

DonaldsonMatrix::DonaldsonMatrix(const std::vector<float>& wavelengths, std::vector<float> values)
    : values_(std::move(values)), count_(int(wavelengths.size())) {
  const size_t n = wavelengths.size();
  if (n < 2) throw Error("a matrix needs at least two wavelengths");
  if (values_.size() != n * n)
    throw Error(fmt::format("{} wavelengths need {} values, row by row, not {}", n, n * n, values_.size()));
  first_ = wavelengths[0];
  step_ = (wavelengths[n - 1] - wavelengths[0]) / float(n - 1);
  for (size_t i = 0; i < n; ++i)
    if (!(step_ > 0) || !(std::abs(wavelengths[i] - (first_ + float(i) * step_)) < 0.01f * step_))
      throw Error(fmt::format("the wavelengths must increase in equal steps; {} nm does not fit", wavelengths[i]));
  if (wavelengths[n - 1] < 10) throw Error("wavelengths are expected in nm; these, all below 10, seem to be in micrometres");

  elastic_.resize(n);
  std::vector<double> absorbed(n), emitted(n);
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) {
      float& value = values_[i * n + j];
      if (!(value >= 0 && std::isfinite(value)))
        throw Error(fmt::format("the value of {} nm at {} nm is {}, which must be neither negative nor infinite",
                                wavelengths[i], wavelengths[j], value));
      if (i == j)
        elastic_[i] = std::exchange(value, 0.0f);
      else
        absorbed[i] += double(value), emitted[j] += double(value);
    }
    const double leaves = double(elastic_[i]) + absorbed[i];
    if (!(leaves <= 1.001))
      throw Error(
          fmt::format("of the light at {} nm the matrix lets {:.4g} times as much leave as arrives; its values are "
                      "fractions of the power, one for each band",
                      wavelengths[i], leaves));
  }
  absorbed_ = table_of(absorbed, first_, step_);
  emitted_ = table_of(emitted, first_, step_);
}

float DonaldsonMatrix::elastic(float wavelength) const {
  const float x = (wavelength - first_) / step_;
  if (!(x >= 0 && x <= float(count_ - 1))) return 0;
  const int i = std::min(int(x), count_ - 2);
  const float t = x - float(i);
  return elastic_[size_t(i)] * (1 - t) + elastic_[size_t(i) + 1] * t;
}

float DonaldsonMatrix::value(float absorbed, float emitted) const {
  const float x = (absorbed - first_) / step_, y = (emitted - first_) / step_, last = float(count_ - 1);
  if (!(x >= 0 && x <= last && y >= 0 && y <= last)) return 0;
  const int i = std::min(int(x), count_ - 2), j = std::min(int(y), count_ - 2);
  const float s = x - float(i), t = y - float(j);
  const float* const d = values_.data() + size_t(i) * size_t(count_) + size_t(j);
  return ((1 - s) * ((1 - t) * d[0] + t * d[1]) + s * ((1 - t) * d[count_] + t * d[count_ + 1])) / step_;
}

DonaldsonMatrix read_donaldson_matrix(const std::string& path) {
  constexpr std::uint64_t most = 64u << 20;  // bytes
  std::istringstream stream;
  try {
    stream.str(read_regular_file(path, most));
  } catch (const std::exception& e) {
    throw Error(fmt::format("cannot read matrix '{}': {}", path, e.what()));
  }
  std::vector<float> wavelengths, values;
  size_t rows = 0;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (number == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
    if (line.find_first_not_of(" \t\r") == line.npos || line.front() == '#') continue;
    const auto fail = [&](const std::string& reason) {
      throw Error(fmt::format("cannot read matrix '{}', line {}: {}", path, number, reason));
    };
    const std::vector<std::string_view> fields = fields_of(line);
    const bool header = wavelengths.empty();
    if (!header && fields.size() != wavelengths.size() + 1)
      fail(fmt::format("it has {} columns where {} are needed", fields.size(), wavelengths.size() + 1));
    for (size_t i = header ? 1 : 0; i < fields.size(); ++i) {
      const std::optional<float> value = number_of(fields[i]);
      if (!value) fail(fmt::format("'{}' is not a finite number", fields[i]));
      if (header)
        wavelengths.push_back(*value);
      else if (i > 0)
        values.push_back(*value);
      else if (rows >= wavelengths.size() || *value != wavelengths[rows])
        fail(fmt::format("rows and columns must have the same wavelengths, and this row is that of {} nm", *value));
    }
    if (header && wavelengths.empty()) fail("the first line holds the emitted wavelengths, after a label");
    if (!header) ++rows;
  }
  if (wavelengths.empty()) throw Error(fmt::format("cannot read matrix '{}': it holds no numbers", path));
  try {
    return {wavelengths, std::move(values)};
  } catch (const Error& e) {
    throw Error(fmt::format("cannot read matrix '{}': {}", path, e.what()));
  }
}

}  // namespace etendue
