#pragma once
// Conversion of numbers and times from and to text, and reading of text files.

#include <cstdint>
#include <string>

namespace etendue {

/// 1234567 as "1,234,567".
std::string grouped(std::uint64_t);
/// "4.2 s", "3 m 07 s", "2 h 05 m".
std::string duration_text(double seconds);
/// "90", "90s", "5m", "1.5h", "1h30m" in seconds. Throws Error, with `option` as location, for anything else.
double parse_duration(const std::string& text, const std::string& option);
/// Exactly `count` integers separated by `separator`. Throws Error with `option` as location for anything else.
void parse_integers(const std::string& text, char separator, int count, int* out, const std::string& option,
                    const std::string& form);

/// The contents of a file. Throws Error with the file's name and the reason.
std::string read_file(const std::string& path);

}  // namespace etendue
