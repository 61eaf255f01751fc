#pragma once
// A source text for the parser, and the errors found in it.

#include <optional>
#include <string>
#include <vector>

#include "etendue/core/error.h"

namespace etendue::language {

/// The contents of a file, or a text in place of a file.
struct Source {
  const char* name = "";  ///< interned; the name in messages
  std::string folder;     ///< the base of relative paths in the text
  std::string text;
  /// For an expression embedded in another text: its line there, and the columns of each byte and of the end. Otherwise empty.
  int line = 0;
  std::vector<int> columns = {};
};

/// Thrown when the maximum number of errors is reached.
struct TooManyErrors {};

/// The context of the current evaluation: called functions and running loops, innermost first.
class Trail {
 public:
  explicit Trail(const Trail* outer) : outer_(outer) {}
  virtual ~Trail() = default;
  Trail(const Trail&) = delete;
  Trail& operator=(const Trail&) = delete;
  /// "in 'tree', called at line 12:5", "with i = 3"; "" if there is nothing to report.
  virtual std::string words(const Location& seen_from) const = 0;
  const Trail* outer() const { return outer_; }

 private:
  const Trail* outer_;
};

/// Collects the errors of one run.
class Diagnostics {
 public:
  static constexpr size_t limit = 50;
  /// The context added to the messages of the following errors; null: none.
  const Trail* trail = nullptr;
  /// Adds an error. Throws TooManyErrors when the limit is reached.
  void add(const Error&);
  /// Adds all errors of a list.
  void add(const Errors&);
  bool empty() const { return errors_.empty(); }
  /// Throws the errors found, in the order of the text; returns if there are none.
  void raise();

 private:
  std::string words_of_trail(const Location& seen_from) const;

  std::vector<Error> errors_;
  std::vector<std::string> bare_;  // the messages without the trail: an error in a loop is reported once
};

/// The error with its own location, or else with the fallback.
Error located(const Error&, Location fallback);

/// Reads a whole file; throws Error at `at` with the system's reason.
std::string read_text_file(const std::string& path, Location at);

/// Stores a text under a name that is not a file, so that `show` finds its lines. Replaces an earlier text.
void remember_text(const char* name, std::string text);

/// The position of the first invalid UTF-8 byte; nothing if the text is valid.
std::optional<size_t> invalid_utf8(const std::string& text);

/// "12:7" or "file:12:7", for messages that name a second place.
std::string place(const Location&, const Location& seen_from);

}  // namespace etendue::language
