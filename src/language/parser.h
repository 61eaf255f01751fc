#pragma once
// Tokens into statements and expressions, by recursive descent with one token of look-ahead.

#include <functional>
#include <memory>
#include <unordered_map>

#include "lexer.h"
#include "syntax.h"

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
  void go_on_with_last(Document&);
  bool may_be_defined(const Token& name);
  void definition(Document&, Token name, bool parameter);
  void valued(Document&, Token name, bool parameter);
  Label path_statement(const char* what);
  // repeating/parsing.cpp: what makes a description scale
  void function(Document&, const Token& name);
  void parameters(Definition&);
  void inclusion(Document&);
  void conditions(Inclusion&);
  Node conditional();
  void comprehension(Node& list);
  using Seen = std::unordered_map<std::string, Location>;
  Node component(const Token& class_name);
  void members(Node& component, const Location& opened);
  void member(Node& component, Seen& seen);
  bool member_value(Node& component, size_t index);
  void recover(bool in_block);
  /// Goes on until `stops` says so outside of all brackets, of which some are `open` already; in a block to its end at most.
  void skip(std::string open, bool in_block, const std::function<bool()>& stops);
  void require_separator(const char* what);

  // repairing/meant.cpp: what was probably meant by what other languages write
  /// " (…)" with what is written here for what the current token begins; "" when nothing is known.
  std::string meant() const;
  bool skip_foreign_word(const Token& word);
  void definition_by_colon(Document&);
  void require_value_before_comment();

  // repairing/repair.cpp: what was probably meant where something is missing
  bool misses_brace(const std::string& class_name);
  bool misses_both_braces_but_one(const std::string& class_name);
  bool two_words(const Token& class_name);
  Node component_without_brace(const Token& class_name);
  bool misses_bracket(Node& component);
  void skip_stray_bracket();
  void note_stranger(const Token& member);

  // expressions.cpp
  Node expression();
  Node words(NodeType, std::string_view word, Node (Parser::*operand)());
  Node disjunction();
  Node conjunction();
  Node inversion();
  Node comparison();
  Node range();
  Node chain(NodeType, char first, char second, Node (Parser::*operand)());
  Node sum();
  Node product();
  Node unary();
  Node power();
  Node postfix();
  Node primary();
  Node indexed(Node);
  Node argument();
  Node named(const Token&);
  Node list();
  void items(Node&, char close, const Location& opened);

  Token take();
  /// Reports a syntax error, unless it only follows from another: nothing has made sense since.
  void report(const std::string& message, const Location&);
  [[noreturn]] void fail(const std::string& message, const Location&);
  /// "expected …, not '…'" at the current token, or nothing more when the lexer has already complained of it.
  [[noreturn]] void unexpected(const std::string& expected);
  /// For an opening bracket that the text ends before closing.
  [[noreturn]] void not_closed(char bracket, const Location& opened);
  /// Whether the current token goes on with the expression before it: inside parentheses ends of lines mean nothing.
  bool continues() const { return bracketed_ || !token_.first_in_line; }
  /// Whether the current token is a word that means something behind a value: no unit and no name.
  bool joins() const;
  /// Whether the current token is this word, and begins a value rather than being a name itself.
  bool begins(std::string_view word) const;

  /// Counts nesting while it lives.
  class Level;
  /// Sets whether ends of lines mean nothing while it lives.
  class Lines;

  Diagnostics& diagnostics_;
  Lexer lexer_;
  Token token_;                    // the next one
  size_t last_end_ = 0;            // the byte behind the last one that was taken
  bool last_may_be_list_ = false;  // that one was a name or closed a bracket
  int depth_ = 0;
  bool bracketed_ = false;
  std::string open_;  // '[' and '(' that are open in the innermost block, for going on after an error

  bool lost_ = false;        // after an error, until something makes sense again
  bool wrong_ = false;       // there was an error
  bool comma_told_ = false;  // that a comma is missing here was reported
  struct Block {
    std::string class_name;
    Location opened;
  };
  std::vector<Block> blocks_;  // that are open, outermost first
  /// The first member that its block's class does not have, but one further out does: where a '}' may be missing.
  struct Stranger {
    std::string member, inner, outer;
    Location at, inner_opened;
  };
  std::unique_ptr<Stranger> stranger_;
  Location last_close_;  // of the last '}' that ended a block

  friend class Level;
};

class Parser::Level {
 public:
  Level(Parser& parser, const Location& at) : parser_(parser) {
    if (parser_.depth_ >= depth_limit) {
      parser_.wrong_ = true;
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
