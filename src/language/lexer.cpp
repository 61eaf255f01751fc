#include "lexer.h"

#include <fmt/format.h>

#include <charconv>

namespace etendue::language {

namespace {

bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool digit(char c) { return c >= '0' && c <= '9'; }
bool symbol(char c) { return c != 0 && std::string_view("{}[](),:;=+-*/^<>").find(c) != std::string_view::npos; }

struct LongSymbol {
  std::string_view text;
  char symbol;
};
constexpr LongSymbol long_symbols[] = {{"==", symbols::equal},
                                       {"!=", symbols::different},
                                       {"<=", symbols::at_most},
                                       {">=", symbols::at_least},
                                       {"..", symbols::range}};

/// Parses the number at the beginning of a text. In "0..3" the number is 0: the points belong to the range.
std::from_chars_result read_double(const char* begin, const char* end, double& value) {
  std::from_chars_result result = std::from_chars(begin, end, value);
  if (result.ptr < end && *result.ptr == '.' && result.ptr > begin && result.ptr[-1] == '.')
    result = std::from_chars(begin, result.ptr - 1, value);
  return result;
}

}  // namespace

std::string symbol_text(char symbol) {
  for (const LongSymbol& s : long_symbols)
    if (s.symbol == symbol) return std::string(s.text);
  return {symbol};
}

bool is_qualified_name(std::string_view text) {
  for (;;) {
    const size_t point = text.find('.');
    if (!is_name(text.substr(0, point))) return false;
    if (point == std::string_view::npos) return true;
    text.remove_prefix(point + 1);
  }
}

bool is_name(std::string_view text) {
  if (text.empty() || !letter(text.front())) return false;
  for (const char c : text)
    if (!letter(c) && !digit(c)) return false;
  return true;
}

std::string Token::words() const {
  switch (type) {
    case TokenType::end: return "the end of the text";
    case TokenType::string: return "a string";
    case TokenType::symbol: return fmt::format("'{}'", symbol_text(symbol));
    default: return fmt::format("'{}'", text);
  }
}

Lexer::Lexer(const Source& source, Diagnostics& diagnostics, size_t begin)
    : source_(source), text_(source.text), diagnostics_(diagnostics) {
  s_.position = begin;
  if (begin == 0 && text_.starts_with("\xEF\xBB\xBF")) s_.position = s_.mark = 3;  // byte order mark
}

Location Lexer::location() {
  if (!source_.columns.empty()) return {source_.name, source_.line, source_.columns[std::min(s_.position, text_.size())]};
  for (; s_.mark < s_.position; ++s_.mark)
    if ((static_cast<unsigned char>(text_[s_.mark]) & 0xC0) != 0x80) ++s_.mark_column;
  // The location may be after the last character, but never within one.
  return {source_.name, s_.line, s_.mark_column};
}

void Lexer::skip_blanks() {
  for (; s_.position < text_.size(); ++s_.position) {
    const char c = text_[s_.position];
    if (c == '\n') {
      ++s_.line;
      s_.mark = s_.position + 1;
      s_.mark_column = 1;
      s_.first_in_line = true;
    } else if (c == '#') {
      note_comment();
      const size_t end = text_.find('\n', s_.position);
      if (end == std::string::npos) {
        s_.position = text_.size();
        return;
      }
      s_.position = end - 1;
    } else if (c != ' ' && c != '\t' && c != '\r') {
      return;
    }
  }
}

void Lexer::note_comment() {
  if (comment_.known() || s_.first_in_line) return;
  comment_ = location();
  comment_begin_ = s_.position;
}

// A hint for a character that has a meaning in other languages but not here.
std::string Lexer::meant_character(size_t begin) const {
  const std::string_view rest = std::string_view(text_).substr(begin);
  switch (rest.front()) {
    case '&': return ": write 'and'";
    case '|': return ": write 'or'";
    case '!': return ": write 'not'";
    case '?': return ": write if … then … else …";
    case '%': return ": the remainder of a division is mod(x, n)";
    case '.': return rest.size() > 1 && begin >= 2 && text_.compare(begin - 2, 2, "..") == 0 ? ": a range is written 0..3" : "";
    case '\'': return ": strings are written in double quotes (\")";
    default: return {};
  }
}

// Reads a name, including qualified names such as small.trunk.
void Lexer::read_name(Token& token) {
  const size_t begin = s_.position;
  while (letter(peek()) || digit(peek()) || (peek() == '.' && letter(peek(1)))) ++s_.position;
  token.type = TokenType::name;
  token.text = text_.substr(begin, s_.position - begin);
}

bool Lexer::read_symbol(Token& token) {
  const std::string_view rest = std::string_view(text_).substr(s_.position);
  token.type = TokenType::symbol;
  for (const LongSymbol& s : long_symbols)
    if (rest.starts_with(s.text)) {
      token.symbol = s.symbol;
      s_.position += s.text.size();
      return true;
    }
  if (!symbol(rest.front())) return false;
  token.symbol = rest.front();
  ++s_.position;
  return true;
}

Token Lexer::next() {
  const size_t before = s_.position;
  comment_ = {};
  skip_blanks();
  Token token;
  token.comment = comment_;
  token.comment_begin = comment_begin_;
  token.joined = s_.position == before;
  token.first_in_line = s_.first_in_line;
  token.at = location();
  token.begin = token.end = s_.position;
  s_.first_in_line = false;
  if (at_end()) return token;
  const char c = peek();
  if (letter(c)) {
    read_name(token);
  } else if (digit(c) || (c == '.' && digit(peek(1)))) {
    read_number(token);
  } else if (c == '"') {
    read_string(token);
  } else if (!read_symbol(token)) {
    const size_t begin = s_.position++;
    while (!at_end() && (static_cast<unsigned char>(peek()) & 0xC0) == 0x80) ++s_.position;
    const auto code = static_cast<unsigned char>(c);
    const std::string shown = code < 0x20 || code == 0x7F ? fmt::format("U+{:04X}", code)
                                                          : fmt::format("'{}'", text_.substr(begin, s_.position - begin));
    report("unexpected character " + shown + meant_character(begin), token.at);
    token.type = TokenType::bad;
  }
  token.end = s_.position;
  return token;
}

size_t Lexer::after_blanks(size_t begin) const {
  size_t i = begin;
  for (; i < text_.size(); ++i) {
    if (text_[i] == '#') {
      i = std::min(text_.find('\n', i), text_.size() - 1);
    } else if (text_[i] != ' ' && text_[i] != '\t' && text_[i] != '\r' && text_[i] != '\n') {
      break;
    }
  }
  return i;
}

bool Lexer::followed_by(std::string_view characters) const {
  const size_t at = after_blanks(s_.position);
  return at < text_.size() && characters.find(text_[at]) != std::string_view::npos;
}

bool Lexer::followed_by_assignment() const {
  const size_t at = after_blanks(s_.position);
  return at < text_.size() && text_[at] == '=' && (at + 1 == text_.size() || text_[at + 1] != '=');
}

bool Lexer::followed_by_name(std::string_view then) const {
  size_t at = after_blanks(s_.position);
  if (at >= text_.size() || !letter(text_[at])) return false;
  if (then.empty()) return true;
  while (at < text_.size() && (letter(text_[at]) || digit(text_[at]))) ++at;
  at = after_blanks(at);
  const std::string_view rest = std::string_view(text_).substr(std::min(at, text_.size()));
  return rest.starts_with(then) && (rest.size() == then.size() || (!letter(rest[then.size()]) && !digit(rest[then.size()])));
}

bool Lexer::ends_line() const {
  size_t at = s_.position;
  while (at < text_.size() && (text_[at] == ' ' || text_[at] == '\t' || text_[at] == '\r')) ++at;
  return at >= text_.size() || text_[at] == '\n' || text_[at] == '#';
}

std::string Lexer::following_member(int& closing) const {
  size_t begin = after_blanks(s_.position);
  for (closing = 0; begin < text_.size() && text_[begin] == '}'; ++closing) begin = after_blanks(begin + 1);
  size_t end = begin;
  while (end < text_.size() && (letter(text_[end]) || digit(text_[end]))) ++end;
  const size_t behind = after_blanks(end);
  return behind < text_.size() && text_[behind] == ':' ? text_.substr(begin, end - begin) : std::string();
}

void Lexer::read_number(Token& token) {
  const char* begin = text_.data() + s_.position;
  const auto [end, error] = read_double(begin, text_.data() + text_.size(), token.number);
  token.type = TokenType::number;
  token.text.assign(begin, end);
  s_.position += size_t(end - begin);
  if (error == std::errc()) return;
  const std::string shown = token.text.size() <= 40 ? token.text : token.text.substr(0, 40) + "…";
  report(fmt::format("the number {} is outside the range of double precision", shown), token.at);
  token.type = TokenType::bad;
}

void Lexer::read_string(Token& token) {
  token.type = TokenType::string;
  const auto bad = [&](const std::string& message, Location at) {
    report(message, at);
    token.type = TokenType::bad;
  };
  ++s_.position;
  for (;; ++s_.position) {
    if (at_end() || peek() == '\n') return bad("the string is not closed in its line: a '\"' is missing", token.at);
    char c = peek();
    if (c == '"') break;
    if (c == 0) {
      bad("a string cannot hold the character U+0000", location());
    } else if (c == '\\') {
      const Location at = location();
      ++s_.position;
      if (at_end() || peek() == '\n') continue;
      c = peek();
      if (c == 'n') {
        c = '\n';
      } else if (c == 't') {
        c = '\t';
      } else if (c != '"' && c != '\\') {
        bad("unknown escape in a string; there are \\\" \\\\ \\n \\t", at);
      }
    }
    token.text += c;
  }
  ++s_.position;
}

// After an item of a list: skips a comma or a new line. The end of the list is accepted but not consumed.
bool Lexer::skip_separator() {
  const int line = s_.line;
  skip_blanks();
  if (peek() == ',') {
    ++s_.position;
    return true;
  }
  return peek() == ']' || s_.line != line;
}

bool Lexer::read_row(std::vector<double>& out, int& count) {
  for (count = 0;;) {
    skip_blanks();
    if (peek() == ']') break;
    const bool negative = peek() == '-';
    if (negative) {
      ++s_.position;
      skip_blanks();
    }
    if (!digit(peek()) && !(peek() == '.' && digit(peek(1)))) return false;
    double value = 0;
    const char* begin = text_.data() + s_.position;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (error != std::errc()) return false;
    s_.position += size_t(end - begin);
    out.push_back(negative ? -value : value);
    if (count < 5) ++count;  // counts above 4 are not a row in any case
    if (!skip_separator()) return false;
  }
  ++s_.position;
  return true;
}

bool Lexer::read_numbers(Numbers& numbers) {
  const State saved = s_;
  const auto nothing = [&] {
    s_ = saved;
    numbers = {};
    return false;
  };
  skip_blanks();
  int count = 0;
  if (peek() != '[') {
    if (!read_row(numbers.values, count) || count == 0) return nothing();
  } else {
    numbers.width = 0;
    for (;;) {
      skip_blanks();
      if (peek() == ']') break;
      if (peek() != '[') return nothing();
      ++s_.position;
      if (!read_row(numbers.values, count) || count < 2 || count > 4) return nothing();
      if (numbers.width == 0) numbers.width = count;
      if (numbers.width != count || !skip_separator()) return nothing();
    }
    ++s_.position;
  }
  s_.first_in_line = false;
  return true;
}

}  // namespace etendue::language
