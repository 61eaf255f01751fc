#pragma once
// Reading of numbers, times and text files.

#include <string>

namespace etendue {

/// "90", "90s", "5m", "1.5h", "1h30m" in seconds. Throws Error, with `option` as location, for anything else.
double parse_duration(const std::string& text, const std::string& option);
/// Exactly `count` integers separated by `separator`. Throws Error with `option` as location for anything else.
void parse_integers(const std::string& text, char separator, int count, int* out, const std::string& option,
                    const std::string& form);

/// The contents of a file. Throws Error with the file's name and the reason.
std::string read_file(const std::string& path);

}  // namespace etendue
