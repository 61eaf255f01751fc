#pragma once
// Tokens into statements and expressions, by recursive descent with one token of look-ahead.

#include <unordered_map>

#include "language/lexer.h"
#include "language/syntax.h"

namespace etendue::language {

class Parser {
 public:
  Parser(const Source&, Diagnostics&, size_t begin = 0);

  Document document();
  /// An expression that must end with the text.
  Node lone_expression();

  /// A syntax error that is already reported; what encloses it goes on after the next separator.
  struct Failed {};
  /// Nothing sensible can follow in this text.
  struct Abandoned {};

 private:
  static constexpr int depth_limit = 256;

  // parser.cpp: statements and blocks
  void statement(Document&);
  void definition(Document&, Token name, bool parameter);
  Label path_statement(const char* what);
  Node component(const Token& class_name);
  void member(Node& component, std::unordered_map<std::string, Location>& seen);
  void recover(bool in_block);
  void require_separator(const char* what);

  // expressions.cpp
  Node expression() { return sum(); }
  Node chain(NodeType, char first, char second, Node (Parser::*operand)());
  Node sum();
  Node product();
  Node unary();
  Node postfix();
  Node primary();
  Node named(const Token&);
  Node list();
  void items(Node&, char close, const Location& opened);

  Token take();
  [[noreturn]] void fail(const std::string& message, const Location&);
  /// "expected …, not '…'" at the current token, or nothing more when the lexer has already complained of it.
  [[noreturn]] void unexpected(const std::string& expected);
  /// For an opening bracket that the text ends before closing.
  [[noreturn]] void not_closed(char bracket, const Location& opened);
  /// Whether the current token goes on with the expression before it: inside parentheses ends of lines mean nothing.
  bool continues() const { return bracketed_ || !token_.first_in_line; }

  /// Counts nesting while it lives.
  class Level;
  /// Sets whether ends of lines mean nothing while it lives.
  class Lines;

  Diagnostics& diagnostics_;
  Lexer lexer_;
  Token token_;  // the next one
  int depth_ = 0;
  bool bracketed_ = false;
  std::string open_;  // '[' and '(' that are open in the innermost block, for going on after an error

  friend class Level;
};

class Parser::Level {
 public:
  Level(Parser& parser, const Location& at) : parser_(parser) {
    if (parser_.depth_ >= depth_limit) {
      parser_.diagnostics_.add(Error("too deeply nested: more than 256 levels of brackets", at));
      throw Abandoned{};
    }
    ++parser_.depth_;
  }
  ~Level() { --parser_.depth_; }
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;

 private:
  Parser& parser_;
};

class Parser::Lines {
 public:
  Lines(Parser& parser, bool bracketed) : parser_(parser), saved_(parser.bracketed_) { parser_.bracketed_ = bracketed; }
  ~Lines() { parser_.bracketed_ = saved_; }
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

 private:
  Parser& parser_;
  bool saved_;
};

}  // namespace etendue::language
