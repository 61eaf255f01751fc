#pragma once
// A text on its way through the parser, and the errors found in it.

#include <optional>
#include <string>
#include <vector>

#include "etendue/core/error.h"

namespace etendue::language {

/// One file, or a text that stands for one.
struct Source {
  const char* name = "";  ///< interned; what messages call it
  std::string folder;     ///< that relative paths in it start from
  std::string text;
  /// For an expression within another text: its line there, and the column of each byte and of the end. Else none.
  int line = 0;
  std::vector<int> columns = {};
};

/// Thrown when the limit of errors is reached.
struct TooManyErrors {};

/// The way to what is evaluated now: the functions that were called and the loops that are run, innermost first.
class Trail {
 public:
  explicit Trail(const Trail* outer) : outer_(outer) {}
  virtual ~Trail() = default;
  Trail(const Trail&) = delete;
  Trail& operator=(const Trail&) = delete;
  /// "in 'tree', called at line 12:5", "with i = 3"; "" where nothing can be said.
  virtual std::string words(const Location& seen_from) const = 0;
  const Trail* outer() const { return outer_; }

 private:
  const Trail* outer_;
};

/// Collects what is wrong in one run.
class Diagnostics {
 public:
  static constexpr size_t limit = 50;
  /// What errors from now on are told with; null: nothing.
  const Trail* trail = nullptr;
  /// Throws TooManyErrors when this was the last one worth showing.
  void add(const Error&);
  /// All those of a list at once.
  void add(const Errors&);
  bool empty() const { return errors_.empty(); }
  /// Throws what was found, in the order of the text; returns when nothing was.
  void raise();

 private:
  std::string words_of_trail(const Location& seen_from) const;

  std::vector<Error> errors_;
  std::vector<std::string> bare_;  // their messages without the trail: a mistake in a loop is told once
};

/// The error with a place: its own when it has one.
Error located(const Error&, Location fallback);

/// Reads a whole file; throws Error at `at` with the system's reason.
std::string read_text_file(const std::string& path, Location at);

/// Keeps the text that goes by a name which is no file, so that `show` finds its lines. Replaces an earlier one.
void remember_text(const char* name, std::string text);

/// Where the text stops being UTF-8; none when it is all valid.
std::optional<size_t> invalid_utf8(const std::string& text);

/// "12:7" or "file:12:7", for messages that name a second place.
std::string place(const Location&, const Location& seen_from);

}  // namespace etendue::language
