#pragma once
// Lexer: from characters to tokens.

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

/// Codes of two-character symbols in Token::symbol.
namespace symbols {
inline constexpr char equal = 1, different = 2, at_most = 3, at_least = 4, range = 5;
}  // namespace symbols

/// The text of a symbol: "{", "==", "..".
std::string symbol_text(char symbol);

struct Token {
  TokenType type = TokenType::end;
  char symbol = 0;
  bool first_in_line = false;  ///< only blanks and comments precede it in its line
  bool joined = false;         ///< nothing, not even a blank, precedes it since the previous token
  double number = 0;
  std::string text;  ///< the name, the string without its quotes, or the number as written
  Location at;
  size_t begin = 0, end = 0;  ///< byte offsets in the text
  Location comment = {};  ///< location of the '#' of a comment between the previous token and this one, in the previous token's
                          ///< line; unknown: none
  size_t comment_begin = 0;  ///< byte offset of the '#'

  bool is(char c) const { return type == TokenType::symbol && symbol == c; }
  /// Whether the token is this word, which is a keyword in some places and an ordinary name elsewhere.
  bool is_word(std::string_view word) const { return type == TokenType::name && text == word; }
  /// The token as messages name it: "'{'", "the end of the file", …
  std::string words() const;
};

bool is_name(std::string_view);
/// Whether the text is a name, or names separated by points: names of a file that was included under a name.
bool is_qualified_name(std::string_view);

class Lexer {
 public:
  /// The source must be valid UTF-8 and outlive the lexer.
  Lexer(const Source&, Diagnostics&, size_t begin = 0);

  Token next();
  /// The whole source text.
  const std::string& text() const { return text_; }
  /// The position after the last token [bytes].
  size_t position() const { return s_.position; }
  /// Suppresses errors about bad tokens while this is true: after a syntax error they are probably its consequences.
  void set_quiet(const bool* quiet) { quiet_ = quiet; }
  /// Whether the next character, after blanks and comments, is one of these.
  bool followed_by(std::string_view characters) const;
  /// Whether the next character is a '=' that is not the first half of "==".
  bool followed_by_assignment() const;
  /// Whether a name follows; with `then`, whether a name and then this word follow.
  bool followed_by_name(std::string_view then = {}) const;
  /// Whether only blanks and comments follow the last token in its line.
  bool ends_line() const;
  /// The name after the last token and any '}', which are counted, if a ':' follows the name; else "".
  std::string following_member(int& closing) const;

  /// Right after a '[': reads a list of plain numbers, or of rows of 2 to 4 plain numbers each, up to its ']' into packed form.
  /// If the list contains anything else, nothing is consumed. This is the fast path for lists of millions of numbers.
  bool read_numbers(Numbers&);

 private:
  struct State {
    size_t position = 0;
    int line = 1;
    size_t mark = 0;      // a position in the line …
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
  Location comment_;  // the first comment since the last token, in that token's line
  size_t comment_begin_ = 0;
};

}  // namespace etendue::language
