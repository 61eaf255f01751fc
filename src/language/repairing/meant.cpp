// Parser: hints for the syntax of other languages, so that the first error shows how it is written here.

#include <fmt/format.h>

#include <algorithm>

#include "language/parser.h"

namespace etendue::language {

namespace {

bool is_hexadecimal(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; });
}

/// A colour such as "#ff0000" at the beginning of a text; "" if there is none.
std::string_view colour_at(std::string_view text) {
  constexpr size_t size = 7;
  if (text.size() < size || !is_hexadecimal(text.substr(1, size - 1))) return {};
  const bool ends = text.size() == size || !std::isalnum(static_cast<unsigned char>(text[size]));
  return ends ? text.substr(0, size) : std::string_view();
}

}  // namespace

std::string Parser::meant() const {
  const std::string_view text = lexer_.text();
  const std::string_view rest = text.substr(std::min(token_.begin, text.size()));
  const char before = token_.joined && token_.begin > 0 ? text[token_.begin - 1] : '\0';
  if (rest.starts_with("//") || rest.starts_with("/*") || (before == '/' && (token_.is('/') || token_.is('*'))))
    return " (# begins a comment)";
  if (before == '*' && token_.is('*')) return " (powers are written x^2)";
  for (const char* word : {"elif", "elseif", "elsif"})
    if (token_.is_word(word)) return " (write else if)";
  if (token_.is('[') && last_may_be_list_ && !token_.joined && !token_.first_in_line)
    return " (an entry of a list is written without a blank before the bracket: list[0])";
  return {};
}

// `let a = 1`, `def f(x) = …`: definitions have no keyword before them. Reports the word; parsing continues with the
// definition.
bool Parser::skip_foreign_word(const Token& word) {
  if (token_.type != TokenType::name || token_.first_in_line || !lexer_.followed_by("=(:")) return false;
  constexpr const char* words[] = {"let", "def", "var",    "const", "function", "func",
                                   "fn",  "fun", "define", "set",   "local",    "auto"};
  if (std::ranges::none_of(words, [&](const char* one) { return word.text == one; })) return false;
  const char* parameters = lexer_.followed_by("(") ? "(…)" : "";
  report(fmt::format("a definition has no '{}' before it: write {}{} = …", word.text, token_.text, parameters), word.at);
  return true;
}

// white: Lambertian { … } outside of all blocks. The value is parsed as if the '=' were there.
void Parser::definition_by_colon(Document& document) {
  Token name = take();
  report(fmt::format("a name is defined by '=', not ':': write {} = …", name.text), token_.at);
  take();  // ':'
  lost_ = false;
  valued(document, std::move(name), false);
}

// Called where a value is expected: if a '#' that was meant as a colour hides it, the next token belongs to the next member.
void Parser::require_value_before_comment() {
  if (!token_.comment.known()) return;
  const bool another = token_.type == TokenType::name && (lexer_.followed_by(":") || lexer_.followed_by_assignment());
  const bool nothing = token_.type == TokenType::end || token_.is('}') || token_.is(',') || token_.is(']') || token_.is(')');
  if (!another && !nothing) return;
  const std::string_view colour = colour_at(std::string_view(lexer_.text()).substr(token_.comment_begin));
  fail(colour.empty() ? std::string("a value is missing before the '#', which begins a comment")
                      : fmt::format("a value is missing: '#' begins a comment; write srgb(\"{}\")", colour),
       token_.comment);
}

}  // namespace etendue::language
