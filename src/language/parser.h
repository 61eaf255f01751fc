#pragma once
// Parser: from tokens to statements and expressions, by recursive descent with one token of look-ahead.

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
  /// Parses an expression that must end with the text.
  Node lone_expression();

  /// A syntax error that is already reported; the enclosing construct continues after the next separator.
  struct Failed {};
  /// Parsing of the text is given up.
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
  // repeating/parsing.cpp: functions, includes, conditionals and comprehensions
  void function(Document&, const Token& name);
  void parameters(Definition&);
  void inclusion(Document&);
  void conditions(Inclusion&);
  Node conditional();
  void comprehension(Node& list);
  using Seen = std::unordered_map<std::string, Location>;
  Node component(const Token& class_name, bool braced = true);
  void members(Node& component, const Location& opened);
  void member(Node& component, Seen& seen);
  bool member_value(Node& component, size_t index);
  void recover(bool in_block);
  /// Skips until `stops` returns true outside of all brackets, of which `open` are already open; within a block at most to its
  /// end.
  void skip(std::string open, bool in_block, const std::function<bool()>& stops);
  void require_separator(const char* what);

  // repairing/meant.cpp: hints for the syntax of other languages
  /// A hint " (…)" with the syntax of this language for the syntax of another language at the current token; "" if there is
  /// none.
  std::string meant() const;
  bool skip_foreign_word(const Token& word);
  void definition_by_colon(Document&);
  void require_value_before_comment();

  // repairing/repair.cpp: guesses of the meaning where something is missing
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
  /// Reports a syntax error, unless it probably follows from an earlier one, because nothing has been parsed successfully
  /// since.
  void report(const std::string& message, const Location&);
  [[noreturn]] void fail(const std::string& message, const Location&);
  /// Reports "expected …, not '…'" at the current token, unless the lexer has already reported the token.
  [[noreturn]] void unexpected(const std::string& expected);
  /// Reports an opening bracket that is not closed at the end of the text.
  [[noreturn]] void not_closed(char bracket, const Location& opened);
  /// Whether the current token may continue the expression before it: within parentheses, ends of lines are ignored.
  bool continues() const { return bracketed_ || !token_.first_in_line; }
  /// Whether the current token is a keyword that may follow a value, and so is neither a unit nor a name.
  bool joins() const;
  /// Whether the current token is this keyword at the beginning of a value, and not a name.
  bool begins(std::string_view word) const;

  /// Counts the nesting depth for its lifetime.
  class Level;
  /// Sets for its lifetime whether ends of lines are ignored.
  class Lines;

  Diagnostics& diagnostics_;
  Lexer lexer_;
  Token token_;                    // the current token, not yet taken
  size_t last_end_ = 0;            // the byte after the last token taken
  bool last_may_be_list_ = false;  // that token was a name or a closing bracket
  int depth_ = 0;
  bool bracketed_ = false;
  std::string open_;  // '[' and '(' that are open in the innermost block, for error recovery

  bool lost_ = false;        // after an error, until something is parsed successfully
  bool wrong_ = false;       // there was an error
  bool comma_told_ = false;  // a missing comma was already reported here
  struct Block {
    std::string class_name;
    Location opened;
  };
  std::vector<Block> blocks_;  // open blocks, outermost first
  /// The first member that the class of its block does not have, but that of an enclosing block has: a '}' may be missing
  /// before it.
  struct Stranger {
    std::string member, inner, outer;
    Location at, inner_opened;
  };
  std::unique_ptr<Stranger> stranger_;
  Location last_close_;  // of the last '}' that closed a block

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
