#pragma once
// Splits a pbrt file into tokens.

#include <string>
#include <string_view>
#include <vector>

#include "etendue/importer.h"

namespace etendue::pbrt {

/// The next token of a file. A word is a directive, a number, true or false.
struct Token {
  enum class Kind : unsigned char { end, word, string, open, close };
  Kind kind = Kind::end;
  std::string_view text;     ///< of a string without quotes, escapes not replaced
  const char* at = nullptr;  ///< position in the text, for Lexer::place

  bool is(Kind k) const { return kind == k; }
  bool end() const { return kind == Kind::end; }
};

/// Splits a text into tokens. The text is not copied, so that lists of millions of numbers are read fast.
class Lexer {
 public:
  /// `file` is interned.
  Lexer(std::string_view text, const char* file);

  /// Set for version 3, which tolerates syntax that version 4 refuses: receives the warnings. Null: such syntax throws Error.
  Importing* lenient = nullptr;

  const Token& peek();
  Token next();
  /// Reads numbers up to the first token that is none.
  void numbers(std::vector<double>& to);
  /// Converts a word to a number; false: it is none. For version 3 the characters after the number are ignored.
  bool number(const Token& word, double& number);

  /// The location of a token. Fast if called in the order of the text.
  Location place(const char* at);
  Location place(const Token& token) { return place(token.at); }
  const char* file() const { return file_; }

  /// The string with its escapes replaced.
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
