#pragma once
// Errors that say where they come from.

#include <stdexcept>
#include <string>
#include <vector>

namespace etendue {

/// A place in a text: a file's name as the user wrote or reached it (or "-D name", "--set …" for the command line).
/// Lines and columns count from 1, columns in characters; line 0 means the file as a whole or nothing at all.
struct Location {
  const char* file = "";  ///< interned, lives as long as the program
  int line = 0, column = 0;
  bool known() const { return *file != 0; }
  bool operator==(const Location&) const = default;
};

/// A file name that lives for ever, for Location.
const char* intern(const std::string&);

/// Something the user can put right: bad input, a missing file, a value out of range. `what()` is the bare message.
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
