#pragma once
// Lines: tokenizer for the lines of words and numbers in OBJ, MTL and OFF files.

#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "etendue/core/error.h"

namespace etendue {

/// The lines of a text; a backslash at a line's end continues it.
class Lines {
 public:
  explicit Lines(std::string_view file) : at_(file.data()), end_(file.data() + file.size()) {}

  bool next() {
    if (at_ >= end_) return false;
    number_ += 1 + continued_;
    continued_ = 0;
    begin_ = at_;
    for (;;) {
      const char* stop = static_cast<const char*>(std::memchr(at_, '\n', size_t(end_ - at_)));
      line_end_ = stop ? stop : end_;
      at_ = stop ? stop + 1 : end_;
      const char* last = line_end_ > begin_ && line_end_[-1] == '\r' ? line_end_ - 1 : line_end_;
      if (!stop || last == begin_ || last[-1] != '\\') break;
      ++continued_;
    }
    cursor_ = begin_;
    skip_space();
    return true;
  }

  /// The line's first word.
  std::string_view keyword() {
    const char* from = cursor_;
    while (cursor_ < line_end_ && !space(*cursor_)) ++cursor_;
    return {from, size_t(cursor_ - from)};
  }
  bool at_end() {
    skip_space();
    return cursor_ >= line_end_ || *cursor_ == '#';
  }
  template <class Number = float>
  Number number() {
    if (at_end()) error("a number is missing");
    if (*cursor_ == '+') ++cursor_;
    Number value = 0;
    const auto [stop, code] = std::from_chars(cursor_, line_end_, value);
    if (code == std::errc::invalid_argument) error("a number is expected");
    // Out of a float's range: a number too large becomes infinite, which makes its triangles unusable; one too small becomes
    // zero.
    if (code == std::errc::result_out_of_range) {
      double wide = 0;
      std::from_chars(cursor_, stop, wide);
      value = Number(wide);
    }
    cursor_ = stop;
    return value;
  }
  std::int64_t integer() {
    std::int64_t value = 0;
    const auto [stop, code] = std::from_chars(cursor_, line_end_, value);
    if (code == std::errc::invalid_argument) error("an index is expected");
    if (code == std::errc::result_out_of_range) value = std::numeric_limits<std::int64_t>::max();
    cursor_ = stop;
    return value;
  }
  bool take(char c) {
    if (cursor_ >= line_end_ || *cursor_ != c) return false;
    ++cursor_;
    return true;
  }
  void skip_space() {
    while (cursor_ < line_end_ && space(*cursor_)) ++cursor_;
  }
  /// The rest of the line, including trailing spaces and comments.
  std::string_view left() const { return {cursor_, size_t(line_end_ - cursor_)}; }
  /// The rest of the line without trailing spaces; empty before a comment.
  std::string_view rest() {
    if (at_end()) return {};
    const char* last = line_end_;
    while (last > cursor_ && space(last[-1])) --last;
    return {cursor_, size_t(last - cursor_)};
  }
  bool word_ends() const { return cursor_ >= line_end_ || space(*cursor_); }

  std::int64_t line() const { return number_; }

  [[noreturn]] void error(const std::string& message) const { throw Error("line " + std::to_string(number_) + ": " + message); }

 private:
  static bool space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\\'; }

  const char *at_, *end_, *begin_ = nullptr, *line_end_ = nullptr, *cursor_ = nullptr;
  std::int64_t number_ = 0, continued_ = 0;
};

}  // namespace etendue
