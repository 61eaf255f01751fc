#include "lexer.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace etendue::pbrt {

namespace {

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
bool ends_word(char c) { return is_space(c) || c == '"' || c == '[' || c == ']' || c == '#'; }
bool starts_number(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.'; }

}  // namespace

Lexer::Lexer(std::string_view text, const char* file)
    : begin_(text.data()), end_(text.data() + text.size()), now_(begin_), file_(file), counted_(begin_), line_begin_(begin_) {
  if (text.starts_with("\xef\xbb\xbf")) now_ += 3;  // a byte order mark
}

const Token& Lexer::peek() {
  if (!peeked_) ahead_ = read();
  peeked_ = true;
  return ahead_;
}

Token Lexer::next() {
  if (!peeked_) return read();
  peeked_ = false;
  return ahead_;
}

void Lexer::skip_space() {
  while (now_ != end_)
    if (is_space(*now_))
      ++now_;
    else if (*now_ == '#')
      while (now_ != end_ && *now_ != '\n') ++now_;
    else
      break;
}

Token Lexer::read() {
  skip_space();
  if (now_ == end_) return {Token::Kind::end, {}, end_};
  const char* at = now_;
  if (*at == '"') return read_string();
  if (*at == '[' || *at == ']') {
    ++now_;
    return {*at == '[' ? Token::Kind::open : Token::Kind::close, {at, 1}, at};
  }
  while (now_ != end_ && !ends_word(*now_)) ++now_;
  return {Token::Kind::word, {at, size_t(now_ - at)}, at};
}

Token Lexer::read_string() {
  const char* at = now_++;
  while (now_ != end_ && *now_ != '"' && *now_ != '\n') now_ += *now_ == '\\' && now_ + 1 != end_ ? 2 : 1;
  if (now_ == end_ || *now_ != '"') throw Error("the string that begins here has no closing '\"' in its line", place(at));
  return {Token::Kind::string, {at + 1, size_t(now_++ - at - 1)}, at};
}

void Lexer::numbers(std::vector<double>& to) {
  if (peeked_) now_ = ahead_.at;
  peeked_ = false;
  for (;;) {
    skip_space();
    if (now_ == end_ || !starts_number(*now_)) return;
    const char* from = now_ + (*now_ == '+' ? 1 : 0);
    double value = 0;
    const auto [rest, error] = std::from_chars(from, end_, value);
    if (error != std::errc() || !std::isfinite(value) || (rest != end_ && !ends_word(*rest))) {
      // A number too small for a double becomes 0; anything else is no number.
      const char* stop = std::find_if(now_, end_, ends_word);
      const std::string_view word{now_, size_t(stop - now_)};
      if (!parse_number(word, value) && !beginning(word, value)) return;
      now_ = stop;
    } else {
      now_ = rest;
    }
    to.push_back(value);
  }
}

bool Lexer::number(const Token& word, double& number) {
  return word.is(Token::Kind::word) && (parse_number(word.text, number) || beginning(word.text, number));
}

// Version 3 calls strtof(), which stops at the first character that is not part of a number, and ignores the rest.
bool Lexer::beginning(std::string_view word, double& number) {
  if (!lenient || word.empty()) return false;
  const char *first = word.data() + (word.front() == '+' ? 1 : 0), *last = word.data() + word.size();
  const auto [rest, error] = std::from_chars(first, last, number);
  if (error != std::errc() || !std::isfinite(number)) return false;
  const bool comma = rest + 1 == last && *rest == ',';
  lenient->inexact(comma ? "a comma behind a number says nothing, as in version 3 of pbrt"
                         : "what stands behind a number without a blank is not read, as in version 3 of pbrt",
                   place(word.data()));
  return true;
}

Location Lexer::place(const char* at) {
  if (at < counted_) {
    counted_ = line_begin_ = begin_;
    line_ = 1;
  }
  while (const void* found = std::memchr(counted_, '\n', size_t(at - counted_))) {
    counted_ = line_begin_ = static_cast<const char*>(found) + 1;
    ++line_;
  }
  counted_ = at;
  const auto begins_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };  // of UTF-8
  return {file_, line_, 1 + int(std::min<std::ptrdiff_t>(std::count_if(line_begin_, at, begins_character), 1'000'000'000))};
}

std::string Lexer::unescaped(std::string_view text) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      result += text[i];
      continue;
    }
    const char c = text[++i];
    result += c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c == 'b' ? '\b' : c == 'f' ? '\f' : c;
  }
  return result;
}

bool parse_number(std::string_view word, double& number) {
  if (word.empty() || !starts_number(word.front())) return false;
  const bool plus = word.front() == '+';
  const auto [rest, error] = std::from_chars(word.data() + (plus ? 1 : 0), word.data() + word.size(), number);
  if (rest != word.data() + word.size()) return false;
  if (error == std::errc::result_out_of_range) {
    // from_chars does not distinguish overflow from underflow.
    number = std::strtod(std::string(word).c_str(), nullptr);
    return std::abs(number) < 1;
  }
  return error == std::errc() && std::isfinite(number);
}

}  // namespace etendue::pbrt
