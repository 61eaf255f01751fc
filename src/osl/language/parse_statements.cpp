// Statements.

#include <array>

#include "parse_steps.h"

namespace etendue::osl::syntax {

StatementPointer Parser::block() {
  const Nest nest(*this);
  auto s = make(Statement::Kind::block, take().place);
  while (!is("}")) {
    if (ended()) refuse(now().place, fmt::format("the block of line {} is not closed", s->place.line));
    try {
      s->statements.push_back(statement());
    } catch (const Abandon&) {
      skip_statement();
    }
  }
  take();
  return s;
}

StatementPointer Parser::branch() {
  auto first = make(Statement::Kind::branch, now().place);
  Statement* last = first.get();
  // A chain of `else if` is a loop here, so that long ones do not nest in the parser.
  for (int length = 0;; ++length) {
    if (length > most_depth) refuse(now().place, fmt::format("more than {} branches of one 'if'", most_depth));
    take();  // if
    expect("(", "behind 'if'");
    last->expression = expression();
    expect(")", "behind the condition");
    last->body = statement();
    if (!accept("else")) break;
    if (!is("if")) {
      last->otherwise = statement();
      break;
    }
    last->otherwise = make(Statement::Kind::branch, now().place);
    last = last->otherwise.get();
  }
  return first;
}

StatementPointer Parser::loop() {
  auto s = make(Statement::Kind::loop, now().place);
  const std::string word = take().text;
  expect("(", "behind the word of a loop");
  if (word == "while") {
    s->expression = expression();
  } else {
    if (!accept(";")) {
      if (at_type() || (now().kind == Token::Kind::name && ahead(1).kind == Token::Kind::name)) {
        s->statements.push_back(declaration());
      } else {
        auto first = make(Statement::Kind::expression, now().place);
        first->expression = expression();
        expect(";", "in a 'for'");
        s->statements.push_back(std::move(first));
      }
    }
    if (!is(";")) s->expression = expression();
    expect(";", "in a 'for'");
    if (!is(")")) s->step = expression();
  }
  expect(")", "in a loop");
  s->body = statement();
  return s;
}

StatementPointer Parser::statement() {
  const Nest nest(*this);
  const Location at = now().place;
  if (is("{")) return block();
  if (accept(";")) return make(Statement::Kind::nothing, at);
  if (now().kind == Token::Kind::name) {
    const std::string& word = now().text;
    if (word == "if") return branch();
    if (word == "for" || word == "while") return loop();
    if (word == "do") {
      auto s = make(Statement::Kind::do_loop, at);
      take();
      s->body = statement();
      expect("while", "behind the body of 'do'");
      expect("(", "behind 'while'");
      s->expression = expression();
      expect(")", "behind the condition");
      expect(";", "behind 'do'");
      return s;
    }
    if (word == "break" || word == "continue") {
      auto s = make(word == "break" ? Statement::Kind::break_loop : Statement::Kind::continue_loop, at);
      take();
      expect(";", "here");
      return s;
    }
    if (word == "return") {
      auto s = make(Statement::Kind::leave, at);
      take();
      if (!is(";")) s->expression = is("{") ? list() : expression();
      expect(";", "behind 'return'");
      return s;
    }
    if (word == "struct" && ahead(2).is("{")) return structure();
    // `float(...)` is an expression, `float x` a declaration; `name name` is one, too.
    const bool constructor = at_type() && !is("closure") && ahead(1).is("(");
    if ((at_type() && !constructor) || word == "struct" || word == "public" ||
        (ahead(1).kind == Token::Kind::name && !is_reserved(word) && !is_reserved(ahead(1).text)))
      return declaration();
  }
  auto s = make(Statement::Kind::expression, at);
  s->expression = expression();
  expect(";", "behind a statement");
  return s;
}

}  // namespace etendue::osl::syntax
