// Writer: numbers, paths and colours as text.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "color/named.h"
#include "files/sent_files.h"
#include "writer.h"

namespace etendue::language {

namespace {

/// The shortest text that gives the same double when it is read in a unit.
std::string exact_text(double value, double factor) {
  const double x = value / factor;
  for (const double near : {x, std::nextafter(x, -HUGE_VAL), std::nextafter(x, HUGE_VAL)})
    if (near * factor == value) return fmt::format("{}", near);
  return fmt::format("{}", x);
}

}  // namespace

std::string number_text(double value, double factor, bool whole, bool exact) {
  if (!std::isfinite(value)) throw Error("a number that is not finite cannot be written");
  const double x = value / factor;
  if (x == std::floor(x) && std::abs(x) < (whole ? 0x1p53 : 1e9) && x * factor == value)
    return fmt::format("{}", std::int64_t(x));
  if (exact) return exact_text(value, factor);
  const auto narrow = float(x);
  if (std::isfinite(narrow) && double(narrow) * factor == value) {
    const std::string text = etendue::number_text(narrow);
    double read = 0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    if (float(read * factor / factor) == narrow) return text;
  }
  return etendue::number_text(x);
}

std::string Writer::unit_suffix(Dimension dimension, const Member* member, double& factor) const {
  if (dimension == Dimension::none) return {};
  const Unit* unit = member ? find_unit(member->unit) : nullptr;
  if (!unit || unit->dimension != dimension) {
    unit = nullptr;
    for (const Unit& u : units())
      if (u.dimension == dimension && u.factor == 1) unit = &u;
    if (!unit) return {};
  }
  factor = unit->factor;
  return " " + std::string(unit->name);
}

std::string Writer::numbers(const Numbers& n, const Member* member, int indent, int column) const {
  if (n.values.empty()) return "[]";
  double factor = 1;
  const std::string suffix = unit_suffix(n.dimension, member, factor);
  const bool whole = member && member->kind == Kind::integer;
  const bool exact = member && member->in_double;
  const auto width = size_t(n.width);
  const auto row = [&](size_t r) {
    std::string text = width > 1 ? "[" : "";
    for (size_t k = 0; k < width; ++k) text += (k > 0 ? ", " : "") + number_text(n.values[r * width + k], factor, whole, exact);
    return width > 1 ? text + "]" : text;
  };
  // On one line if that is short; otherwise in filled lines.
  std::string text = "[";
  constexpr size_t short_line = 100, long_line = 120;
  size_t r = 0;
  for (; r < n.rows() && size_t(column) + text.size() <= short_line; ++r) text += (r > 0 ? ", " : "") + row(r);
  if (r == n.rows() && size_t(column) + text.size() + 1 + suffix.size() <= short_line) return text + "]" + suffix;
  const std::string margin(size_t(indent) + 4, ' ');
  text = "[\n" + margin;
  size_t used = margin.size();
  for (r = 0; r < n.rows(); ++r) {
    const std::string item = row(r) + ",";
    if (used > margin.size() && used + 1 + item.size() > long_line) {
      text += "\n" + margin;
      used = margin.size();
    } else if (used > margin.size()) {
      text += ' ';
      ++used;
    }
    text += item;
    used += item.size();
  }
  return text + "\n" + std::string(size_t(indent), ' ') + "]" + suffix;
}

namespace {

std::filesystem::path absolute(const std::string& path) {
  std::error_code error;
  const auto result = std::filesystem::absolute(path.empty() ? "." : path, error);
  const auto normal = (error ? std::filesystem::path(path) : result).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();  // "/a/b/" as "/a/b"
}

}  // namespace

std::string path_text(const FilePath& file, const std::string& folder) {
  if (file.text.empty() || file.folder == folder) return file.text;
  if (file.text.front() == '/') return where_sent_from(file.text);
  const std::string path = file.resolved();
  if (folder.empty()) return absolute(path).string();
  if (path.starts_with(folder + "/")) return path.substr(folder.size() + 1);  // keeps the spelling
  return absolute(path).lexically_relative(absolute(folder)).string();
}

std::string color_text(const SpectralFunction& color, const std::string& folder) {
  const std::string expression = color.expression();
  static constexpr std::string_view call = "spectrum(\"";
  std::string result;
  size_t done = 0;
  for (size_t at = expression.find(call); at != std::string::npos; at = expression.find(call, done)) {
    const size_t begin = at + call.size();
    std::string path;
    size_t end = begin;
    for (; end < expression.size() && expression[end] != '"'; ++end) {
      if (expression[end] != '\\' || end + 1 == expression.size()) {
        path += expression[end];
        continue;
      }
      const char escaped = expression[++end];
      path += escaped == 'n' ? '\n' : (escaped == 't' ? '\t' : escaped);
    }
    // Only paths in the folder or near it are written relative to it: a path that goes up to the root would be less clear.
    path = where_sent_from(path);
    const std::filesystem::path here = where_sent_from(absolute(folder).string()),
                                relative = absolute(path).lexically_relative(here);
    const auto up = std::count(relative.begin(), relative.end(), "..");
    const bool near = !relative.empty() && up < std::distance(here.begin(), here.end()) - 1;
    result +=
        expression.substr(done, begin - 1 - done) + etendue::quoted(path.starts_with('/') && near ? relative.string() : path);
    done = std::min(end + 1, expression.size());
  }
  return result + expression.substr(done);
}

}  // namespace etendue::language
