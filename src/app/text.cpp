// Reading of numbers, times and text files.

#include "text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "etendue/core/error.h"
#include "files/regular_file.h"

namespace etendue {

double parse_duration(const std::string& text, const std::string& option) {
  const auto wrong = [&] {
    return Error(fmt::format("'{}' is not a duration; write seconds, or 90s, 5m, 1h, 1h30m", text), {intern(option), 0, 0});
  };
  const char* at = text.data();
  const char* const end = at + text.size();
  double seconds = 0, largest_unit = INFINITY;
  if (at == end) throw wrong();
  while (at != end) {
    double number = 0;
    const auto [after, problem] = std::from_chars(at, end, number);
    if (problem != std::errc() || !(number >= 0) || !std::isfinite(number)) throw wrong();
    const bool plain = after == end;
    const double unit = plain || *after == 's' ? 1 : *after == 'm' ? 60 : *after == 'h' ? 3600 : 0;
    // Each unit occurs once, the largest first; a number without a unit stands alone.
    if (unit == 0 || unit >= largest_unit || (plain && at != text.data())) throw wrong();
    largest_unit = unit;
    seconds += number * unit;
    at = plain ? end : after + 1;
  }
  if (seconds <= 0) throw wrong();
  return seconds;
}

void parse_integers(const std::string& text, char separator, int count, int* out, const std::string& option,
                    const std::string& form) {
  const auto wrong = [&] { return Error(fmt::format("'{}' is not of the form {}", text, form), {intern(option), 0, 0}); };
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int i = 0; i < count; ++i) {
    const auto [after, problem] = std::from_chars(at, end, out[i]);
    if (problem != std::errc()) throw wrong();
    const bool last = i + 1 == count;
    if (last ? after != end : after == end || *after != separator) throw wrong();
    at = last ? end : after + 1;
  }
}

std::string read_file(const std::string& path) {
  try {
    return read_regular_file(path);
  } catch (const Error& e) {
    throw Error(fmt::format("cannot read '{}': {}", path, e.what()));
  }
}

}  // namespace etendue
