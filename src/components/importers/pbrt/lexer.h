#pragma once
// The words of a pbrt file.

#include <string>
#include <string_view>
#include <vector>

#include "etendue/importer.h"

namespace etendue::pbrt {

/// What stands next in a file. A word is a directive, a number, true or false.
struct Token {
  enum class Kind : unsigned char { end, word, string, open, close };
  Kind kind = Kind::end;
  std::string_view text;     ///< of a string without its quotes, escapes as they are written
  const char* at = nullptr;  ///< in the text, for Lexer::place

  bool is(Kind k) const { return kind == k; }
  bool end() const { return kind == Kind::end; }
};

/// Takes a text apart. It is not copied, so that lists of millions of numbers are read at the speed of their digits.
class Lexer {
 public:
  /// `file` is interned.
  Lexer(std::string_view text, const char* file);

  /// Of version 3, which reads on where version 4 stops: whom it tells. Null: what is wrong is an Error.
  Importing* lenient = nullptr;

  const Token& peek();
  Token next();
  /// Reads numbers as long as there are some.
  void numbers(std::vector<double>& to);
  /// A word as a number; false: it is none. What stands behind the digits version 3 does not look at.
  bool number(const Token& word, double& number);

  /// Where a token stands. Quick when asked in the order of the text.
  Location place(const char* at);
  Location place(const Token& token) { return place(token.at); }
  const char* file() const { return file_; }

  /// What a string with its escapes stands for.
  static std::string unescaped(std::string_view);

 private:
  void skip_space();
  Token read();
  Token read_string();
  bool beginning(std::string_view word, double& number);

  const char* begin_;
  const char* end_;
  const char* now_;
  const char* file_;
  const char* counted_;  // lines are counted up to here
  const char* line_begin_;
  int line_ = 1;
  Token ahead_;
  bool peeked_ = false;
};

/// A word as a number; false: it is none, or not finite.
bool parse_number(std::string_view word, double& number);

}  // namespace etendue::pbrt
