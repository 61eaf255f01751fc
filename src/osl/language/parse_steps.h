#pragma once
// The parser's steps, by what they parse: parse_declarations.cpp, parse_statements.cpp, parse_expressions.cpp. parser.cpp has
// what they share.

#include <fmt/format.h>

#include "parser.h"

namespace etendue::osl::syntax {

/// Ends the statement or declaration that is being parsed, after its error was reported.
struct Abandon {};

/// "int", "float", ...
bool is_simple_type(const std::string&);
/// Whether a name is a word of the language, or of C, which is reserved for the future: no variable may have it.
bool is_reserved(const std::string&);

class Parser {
 public:
  Parser(std::span<const Token> tokens, Diagnostics& d) : tokens_(tokens), diagnostics_(d) {}

  File file();
  std::shared_ptr<FunctionDeclaration> signature();

 private:
  // Tokens
  const Token& now() const { return tokens_[at_]; }
  const Token& ahead(std::size_t n) const { return tokens_[std::min(at_ + n, tokens_.size() - 1)]; }
  bool is(const char* text) const { return now().is(text); }
  bool ended() const { return now().kind == Token::Kind::end; }
  Token take() {
    const Token& t = tokens_[at_];
    if (at_ + 1 < tokens_.size()) ++at_;
    return t;
  }
  bool accept(const char* text) {
    if (!is(text)) return false;
    take();
    return true;
  }
  void expect(const char* text, const char* where);
  [[noreturn]] void refuse(Location at, const std::string& text) {
    diagnostics_.error(at, text);
    throw Abandon{};
  }
  std::string shown() const { return ended() ? std::string("the end of the text") : "'" + now().text.substr(0, 40) + "'"; }
  Token identifier(const char* what);
  void skip_statement();

  /// Counts how deeply the parser calls itself.
  struct Nest {
    Parser& parser;
    explicit Nest(Parser& p) : parser(p) {
      if (++parser.nesting_ > most_nesting) {
        --parser.nesting_;
        parser.refuse(parser.now().place, fmt::format("this nests more than {} deep", most_nesting));
      }
    }
    ~Nest() { --parser.nesting_; }
  };

  // Declarations
  bool at_type(std::size_t n = 0) const;
  TypeName type();
  std::vector<Declarator> metadata();
  std::vector<Declarator> parameters(bool of_shader, FunctionDeclaration* variadic);
  void array_length(Declarator&);
  Declarator declarator(const TypeName&);
  StatementPointer declaration();
  StatementPointer structure();
  StatementPointer function(const TypeName& result, bool array);
  bool at_shader() const;
  std::unique_ptr<ShaderDeclaration> shader();

  // Statements
  StatementPointer statement();
  StatementPointer block();
  StatementPointer branch();
  StatementPointer loop();
  StatementPointer make(Statement::Kind kind, Location at) const {
    auto s = std::make_unique<Statement>();
    s->kind = kind, s->place = at;
    return s;
  }

  // Expressions
  ExpressionPointer expression();  ///< with commas
  ExpressionPointer assignment();
  ExpressionPointer conditional();
  ExpressionPointer binary(int least);
  ExpressionPointer unary();
  ExpressionPointer postfix();
  ExpressionPointer primary();
  ExpressionPointer list();
  std::vector<ExpressionPointer> arguments(const char* close);
  ExpressionPointer make(Expression::Kind, Location, std::vector<ExpressionPointer> = {});
  template <class... Parts>
  ExpressionPointer make(Expression::Kind kind, Location at, ExpressionPointer first, Parts... rest) {
    std::vector<ExpressionPointer> parts;
    parts.push_back(std::move(first));
    (parts.push_back(std::move(rest)), ...);
    return make(kind, at, std::move(parts));
  }

  std::span<const Token> tokens_;
  Diagnostics& diagnostics_;
  std::size_t at_ = 0;
  int nesting_ = 0;
};

}  // namespace etendue::osl::syntax
