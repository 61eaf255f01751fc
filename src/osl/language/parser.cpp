#include "parser.h"

#include <iterator>
#include <string_view>
#include <unordered_set>

#include "parse_steps.h"

namespace etendue::osl::syntax {

namespace {

// Names of the language that cannot be variables; those of C that are reserved for the future among them.
constexpr std::string_view reserved[] = {
    "and",      "break",       "closure",    "color",   "continue", "do",      "else",      "emit",    "float",   "for",
    "if",       "illuminance", "illuminate", "int",     "matrix",   "normal",  "not",       "or",      "output",  "point",
    "public",   "return",      "string",     "struct",  "vector",   "void",    "while",     "bool",    "case",    "catch",
    "char",     "class",       "const",      "delete",  "default",  "double",  "enum",      "extern",  "false",   "friend",
    "goto",     "inline",      "long",       "new",     "operator", "private", "protected", "short",   "signed",  "sizeof",
    "static",   "switch",      "template",   "this",    "throw",    "true",    "try",       "typedef", "uniform", "union",
    "unsigned", "varying",     "virtual",    "volatile"};

}  // namespace

bool is_simple_type(const std::string& word) {
  static const std::unordered_set<std::string_view> words = {"int",    "float",  "color",  "point", "vector",
                                                             "normal", "matrix", "string", "void"};
  return words.contains(word);
}
bool is_reserved(const std::string& word) {
  static const std::unordered_set<std::string_view> words(std::begin(reserved), std::end(reserved));
  return words.contains(word);
}

void Parser::expect(const char* text, const char* where) {
  if (!accept(text)) refuse(now().place, fmt::format("'{}' is expected {}, not {}", text, where, shown()));
}

Token Parser::identifier(const char* what) {
  if (now().kind != Token::Kind::name) refuse(now().place, fmt::format("{} is expected, not {}", what, shown()));
  if (is_reserved(now().text))
    refuse(now().place, fmt::format("'{}' is a word of the language and cannot be {}", now().text, what));
  return take();
}

/// Goes behind the next semicolon or closed block, or before the brace that closes this one.
void Parser::skip_statement() {
  int open = 0;
  while (!ended()) {
    if (is("{")) {
      ++open;
    } else if (is("}")) {
      if (open == 0) return;
      if (--open == 0) {
        take();
        return;
      }
    } else if (is(";") && open == 0) {
      take();
      return;
    }
    take();
  }
}

}  // namespace etendue::osl::syntax

namespace etendue::osl {

syntax::File parse(std::span<const Token> tokens, Diagnostics& diagnostics) {
  return syntax::Parser(tokens, diagnostics).file();
}

std::shared_ptr<syntax::FunctionDeclaration> parse_signature(const std::string& text) {
  Diagnostics diagnostics(1);
  const std::vector<Token> tokens = cut(text, {intern("the library"), 0, 0});
  try {
    return syntax::Parser(tokens, diagnostics).signature();
  } catch (const syntax::Abandon&) {
  } catch (const Diagnostics::Stop&) {
  }
  throw Error(fmt::format("the signature '{}': {}", text, diagnostics.list.empty() ? "wrong" : diagnostics.list[0].text));
}

}  // namespace etendue::osl
