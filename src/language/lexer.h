#pragma once
// Characters into tokens.

#include <string>
#include <vector>

#include "etendue/describe/value.h"
#include "source.h"

namespace etendue::language {

enum class TokenType : std::uint8_t {
  end,
  name,
  number,
  string,
  symbol,
  bad  ///< already reported
};

/// Symbols of two characters, as Token::symbol has them.
namespace symbols {
inline constexpr char equal = 1, different = 2, at_most = 3, at_least = 4, range = 5;
}  // namespace symbols

/// A symbol as it is written: "{", "==", "..".
std::string symbol_text(char symbol);

struct Token {
  TokenType type = TokenType::end;
  char symbol = 0;
  bool first_in_line = false;  ///< nothing but blanks and comments stand before it in its line
  bool joined = false;         ///< nothing at all stands between it and the token before
  double number = 0;
  std::string text;  ///< the name, the string without its quotes, or the number as written
  Location at;
  size_t begin = 0, end = 0;  ///< bytes in the text
  Location comment = {};  ///< of the '#' that hides the rest of the line behind the token before this one; unknown: none does
  size_t comment_begin = 0;  ///< its byte

  bool is(char c) const { return type == TokenType::symbol && symbol == c; }
  /// Whether it is this word, which has a meaning in some places and is a name like any other elsewhere.
  bool is_word(std::string_view word) const { return type == TokenType::name && text == word; }
  /// As messages call it: "'{'", "the end of the file", …
  std::string words() const;
};

bool is_name(std::string_view);
/// A name, or names with points between: of what an included file defines that was given a name of its own.
bool is_qualified_name(std::string_view);

class Lexer {
 public:
  /// The source must be valid UTF-8 and outlive the lexer.
  Lexer(const Source&, Diagnostics&, size_t begin = 0);

  Token next();
  /// The whole that is read.
  const std::string& text() const { return text_; }
  /// Right behind the last token [bytes].
  size_t position() const { return s_.position; }
  /// Says nothing of bad tokens while this is true: where the parser is lost, they follow from what made it so.
  void set_quiet(const bool* quiet) { quiet_ = quiet; }
  /// Whether what follows the last token, blanks and comments aside, is one of these characters.
  bool followed_by(std::string_view characters) const;
  /// Whether what follows is a '=' that is not the first half of "==".
  bool followed_by_assignment() const;
  /// Whether a name follows, or one that is followed by this word.
  bool followed_by_name(std::string_view then = {}) const;
  /// Whether nothing but blanks and comments stands behind the last token in its line.
  bool ends_line() const;
  /// The name that follows the last token and any '}' behind it, which are counted, if a ':' stands behind the name; else "".
  std::string following_member(int& closing) const;

  /// Right after a '[': reads a list of plain numbers, or of rows of 2 to 4 plain numbers each, to its ']' into packed
  /// form. When the list holds anything else nothing is read. Lists of millions of numbers take this way.
  bool read_numbers(Numbers&);

 private:
  struct State {
    size_t position = 0;
    int line = 1;
    size_t mark = 0;      // a place in the line …
    int mark_column = 1;  // … and its column, so that long lines are counted once
    bool first_in_line = true;
  };

  char peek(size_t ahead = 0) const { return s_.position + ahead < text_.size() ? text_[s_.position + ahead] : '\0'; }
  size_t after_blanks(size_t begin) const;
  bool at_end() const { return s_.position >= text_.size(); }
  void skip_blanks();
  void note_comment();
  std::string meant_character(size_t begin) const;
  Location location();
  void report(const std::string& message, Location at) const {
    if (!quiet_ || !*quiet_) diagnostics_.add(Error(message, at));
  }
  void read_string(Token&);
  void read_number(Token&);
  void read_name(Token&);
  bool read_symbol(Token&);
  bool skip_separator();
  bool read_row(std::vector<double>&, int& count);

  const Source& source_;
  const std::string& text_;
  Diagnostics& diagnostics_;
  State s_;
  const bool* quiet_ = nullptr;
  Location comment_;  // the first one since the last token, in its line
  size_t comment_begin_ = 0;
};

}  // namespace etendue::language
