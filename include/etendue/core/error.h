#pragma once
// Error: exceptions with the location in the input that caused them.

#include <stdexcept>
#include <string>
#include <vector>

namespace etendue {

/// A location in a text: the file's name as written by the user or found by searching (or "-D name", "--set …" for the command
/// line). Lines and columns count from 1, columns in characters; line 0 means the file as a whole, or no location.
struct Location {
  const char* file = "";  ///< interned, lives as long as the program
  int line = 0, column = 0;
  bool known() const { return *file != 0; }
  bool operator==(const Location&) const = default;
};

/// A copy of a file name that is never freed, for Location.
const char* intern(const std::string&);

/// An error that the user can correct: bad input, a missing file, a value out of range. `what()` is the message without the
/// location.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, Location at = {}) : std::runtime_error(message), location(at) {}
  Location location;
};

/// Several errors found in one run.
class Errors : public std::runtime_error {
 public:
  explicit Errors(std::vector<Error> list)
      : std::runtime_error(list.empty() ? "errors" : list.front().what()), errors(std::move(list)) {}
  std::vector<Error> errors;
};

/// " (did you mean 'x'?)" for the known name nearest to the given one by edit distance, or "" when none is near.
std::string suggestion(const std::string& given, const std::vector<std::string>& known);

}  // namespace etendue
