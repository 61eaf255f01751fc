#pragma once
// Number and string literals of the render description language, and look-up of named data.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// The shortest literal that parses to the same number.
std::string number_text(double);
std::string number_text(float);
/// A string literal of the language, with its quotes.
std::string quoted(std::string_view);

/// Whether `given` is `name` or one of `aliases` (separated by commas), ignoring case.
bool is_named(std::string_view given, std::string_view name, std::string_view aliases);
/// Throws Error: "unknown glass 'BK8' (did you mean 'BK7'?); known are …". `others` (lists separated by commas) may be
/// suggested but are not listed.
[[noreturn]] void fail_unknown(const std::string& what, const std::string& given, const std::vector<std::string>& known,
                               const std::vector<std::string>& others = {});

/// The names of a table of src/color/tables.h.
template <class T>
std::vector<std::string> names_of(std::span<const T> table) {
  std::vector<std::string> names;
  for (const T& entry : table) names.emplace_back(entry.name);
  return names;
}
/// The entry with this name or alias; throws Error if there is none.
template <class T>
const T& find_named(std::span<const T> table, const std::string& what, const std::string& given) {
  for (const T& entry : table)
    if (is_named(given, entry.name, entry.aliases)) return entry;
  std::vector<std::string> aliases;
  for (const T& entry : table) aliases.emplace_back(entry.aliases);
  fail_unknown(what, given, names_of(table), aliases);
}

}  // namespace etendue
