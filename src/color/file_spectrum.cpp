// Spectra from CSV and SPD files.

#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "files/regular_file.h"
#include "named.h"
#include "table_spectrum.h"

namespace etendue {

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n";
  const size_t first = text.find_first_not_of(blank);
  if (first == text.npos) return {};
  text = text.substr(first, text.find_last_not_of(blank) - first + 1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

/// Fields are separated by semicolons if there are any, else commas, else tabs, else blanks.
std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (const char separator : {';', ',', '\t'}) {
    if (line.find(separator) == line.npos) continue;
    for (size_t begin = 0; begin <= line.size();) {
      const size_t end = std::min(line.find(separator, begin), line.size());
      fields.push_back(trimmed(line.substr(begin, end - begin)));
      begin = end + 1;
    }
    return fields;
  }
  for (size_t begin = line.find_first_not_of(' '); begin != line.npos && begin < line.size();) {
    const size_t end = std::min(line.find(' ', begin), line.size());
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    begin = line.find_first_not_of(' ', end);
  }
  return fields;
}

std::optional<double> number_of(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

class SpectrumFile {
 public:
  SpectrumFile(const FilePath& file, const std::string& column) : path_(file.resolved()), column_(column) {
    std::istringstream stream(contents());
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
      if (number == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
      const std::string_view text = trimmed(line);
      if (!text.empty() && text.front() != '#') take(text, number);
    }
    if (wavelengths.empty()) fail(0, "it holds no numbers");
    if (wavelengths.size() < 2) fail(0, "it holds one wavelength, at least two are needed");
    if (wavelengths.back() < 10) fail(0, "wavelengths are expected in nm; these, all below 10, seem to be in micrometres");
  }

  std::vector<float> wavelengths, values;

 private:
  std::string contents() const {
    constexpr std::uint64_t most = 64u << 20;  // bytes; spectrum files have about 10 kB
    try {
      return read_regular_file(path_, most);
    } catch (const Error& e) {
      fail(0, e.what());
    }
  }

  void take(std::string_view line, int number) {
    const std::vector<std::string_view> fields = fields_of(line);
    if (!index_) {
      const bool header = !number_of(fields[0]);
      index_ = choose(header ? fields : std::vector<std::string_view>(), fields.size(), number);
      if (header) return;
    }
    if (fields.size() <= *index_)
      fail(number, "it has " + std::to_string(fields.size()) + " columns where " + std::to_string(*index_ + 1) + " are needed");
    const double wavelength = parse(fields[0], number), value = parse(fields[*index_], number);
    if (!wavelengths.empty() && !(float(wavelength) > wavelengths.back()))
      fail(number, "wavelengths must increase: " + std::string(fields[0]) + " follows " + number_text(wavelengths.back()));
    wavelengths.push_back(float(wavelength));
    values.push_back(float(value));
  }

  /// The index of the requested column, by its name in the header or its number, counted from 1; without a request the second.
  size_t choose(const std::vector<std::string_view>& names, size_t count, int line) const {
    size_t index = 1;
    if (!column_.empty()) {
      for (size_t i = 0; i < names.size(); ++i)
        if (names[i] == column_) return i;
      const std::optional<double> asked = number_of(column_);
      if (!asked || *asked != std::floor(*asked)) {
        const std::vector<std::string> known(names.begin(), names.end());
        fail(line, known.empty() ? "there is no header to name column '" + column_ + "'"
                                 : "there is no column '" + column_ + "'" + suggestion(column_, known));
      }
      if (!(*asked >= 1 && *asked <= double(count)))
        fail(line, "there is no column " + column_ + ", only " + std::to_string(count));
      index = size_t(*asked) - 1;
    }
    if (count < 2) fail(line, "two columns are needed, wavelength and value");
    return index;
  }

  double parse(std::string_view text, int line) const {
    const std::optional<double> value = number_of(text);
    if (!value) fail(line, text.empty() ? "a number is missing" : "'" + std::string(text) + "' is not a number");
    if (!std::isfinite(*value) || !std::isfinite(float(*value)))
      fail(line, "'" + std::string(text) + "' is not a finite number");
    return *value;
  }

  [[noreturn]] void fail(int line, const std::string& reason) const {
    throw Error("cannot read spectrum '" + path_ + "'" + (line > 0 ? ", line " + std::to_string(line) : "") + ": " + reason);
  }

  std::string path_, column_;
  std::optional<size_t> index_;  // of the values' column; set at the first line that is no comment
};

}  // namespace

Color file_spectrum(const FilePath& file, const std::string& column) {
  SpectrumFile table(file, column);
  return make_table_spectrum(std::move(table.wavelengths), std::move(table.values),
                             "spectrum(" + quoted(file.text) + (column.empty() ? "" : ", " + quoted(column)) + ")");
}

}  // namespace etendue
