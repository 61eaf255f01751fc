#include "lexer.h"

#include <fmt/format.h>

#include <cctype>

namespace etendue::osl {

namespace {

bool digit(char c) { return c >= '0' && c <= '9'; }
bool letter(char c) { return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// The text between quotes, escapes resolved.
std::string unescape(const std::string& quoted) {
  std::string out;
  for (std::size_t i = 1; i + 1 < quoted.size(); ++i) {
    if (quoted[i] != '\\' || i + 2 >= quoted.size()) {
      out += quoted[i];
      continue;
    }
    const char c = quoted[++i];
    switch (c) {
      case 'n': out += '\n'; break;
      case 't': out += '\t'; break;
      case 'r': out += '\r'; break;
      case 'b': out += '\b'; break;
      case 'v': out += '\v'; break;
      case 'f': out += '\f'; break;
      case 'a': out += '\a'; break;
      case '\n': break;
      default:
        if (c >= '0' && c <= '7') {  // octal, up to three digits
          int value = 0, count = 0;
          while (count < 3 && i + 1 < quoted.size() && quoted[i] >= '0' && quoted[i] <= '7')
            value = value * 8 + (quoted[i++] - '0'), ++count;
          --i;
          out += char(value);
        } else {
          out += c;
        }
    }
  }
  return out;
}

/// Where a number of the language that begins at `at` ends.
std::size_t number_end(const std::string& text, std::size_t at, bool& real) {
  real = false;
  if (text[at] == '0' && at + 1 < text.size() && (text[at + 1] == 'x' || text[at + 1] == 'X')) {
    at += 2;
    while (at < text.size() && std::isxdigit(static_cast<unsigned char>(text[at]))) ++at;
    return at;
  }
  while (at < text.size() && digit(text[at])) ++at;
  if (at < text.size() && text[at] == '.') {
    real = true;
    ++at;
    while (at < text.size() && digit(text[at])) ++at;
  }
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    std::size_t exponent = at + 1;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    if (exponent < text.size() && digit(text[exponent])) {
      real = true;
      at = exponent;
      while (at < text.size() && digit(text[at])) ++at;
    }
  }
  return at;
}

}  // namespace

void append_token(const std::string& text, Location at, std::vector<Token>& out, Diagnostics& diagnostics) {
  if (text.empty()) return;
  const char first = text[0];
  if (first == '"') {
    if (text.size() < 2 || text.back() != '"') {
      diagnostics.error(at, "a string without its end");
      return;
    }
    out.push_back({Token::Kind::text, unescape(text), at});
  } else if (letter(first)) {
    out.push_back({Token::Kind::name, text, at});
  } else if (digit(first) || (first == '.' && text.size() > 1 && digit(text[1]))) {
    bool real = false;
    const std::size_t end = number_end(text, 0, real);
    out.push_back({real ? Token::Kind::real : Token::Kind::integer, text.substr(0, end), at});
    if (end < text.size()) {
      // C's suffixes and preprocessing numbers ("1.x"): what follows is a token of its own.
      if (letter(text[end]))
        diagnostics.error(
            at, fmt::format("'{}' is no number of this language: '{}' behind it is too much", text, text.substr(end)));
      else
        append_token(text.substr(end), at, out, diagnostics);
    }
  } else if (first == '\'' || static_cast<unsigned char>(first) >= 128 || first == '$' || first == '@' || first == '`' ||
             first == '\\') {
    diagnostics.error(
        at, fmt::format("the character '{}' means nothing here", first == '\'' ? std::string("'") : text.substr(0, 8)));
  } else {
    out.push_back({Token::Kind::sign, text, at});
  }
}

void join_texts(std::vector<Token>& tokens) {
  std::size_t to = 0;
  for (std::size_t from = 0; from < tokens.size(); ++from) {
    if (to > 0 && tokens[from].kind == Token::Kind::text && tokens[to - 1].kind == Token::Kind::text) {
      tokens[to - 1].text += tokens[from].text;
    } else {
      if (to != from) tokens[to] = std::move(tokens[from]);
      ++to;
    }
  }
  tokens.resize(to);
}

std::vector<Token> cut(const std::string& text, Location at) {
  std::vector<Token> out;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == ' ') {
      ++i;
    } else if (letter(text[i])) {
      std::size_t end = i;
      while (end < text.size() && (letter(text[end]) || digit(text[end]))) ++end;
      out.push_back({Token::Kind::name, text.substr(i, end - i), at});
      i = end;
    } else if (digit(text[i])) {
      bool real = false;
      const std::size_t end = number_end(text, i, real);
      out.push_back({real ? Token::Kind::real : Token::Kind::integer, text.substr(i, end - i), at});
      i = end;
    } else {
      const std::size_t length = text.compare(i, 3, "...") == 0 ? 3 : 1;
      out.push_back({Token::Kind::sign, text.substr(i, length), at});
      i += length;
    }
  }
  out.push_back({Token::Kind::end, {}, at});
  return out;
}

}  // namespace etendue::osl
