// Expressions.

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <limits>

#include "parse_steps.h"

namespace etendue::osl::syntax {

namespace {

struct BinaryOperator {
  const char* sign;
  int precedence;  ///< higher binds more strongly, as in C
  Operator operation;
};
constexpr BinaryOperator binary_operators[] = {
    {"||", 1, Operator::none},          {"or", 1, Operator::none},
    {"&&", 2, Operator::none},          {"and", 2, Operator::none},
    {"|", 3, Operator::bit_or},         {"^", 4, Operator::bit_xor},
    {"&", 5, Operator::bit_and},        {"==", 6, Operator::equal},
    {"!=", 6, Operator::unequal},       {"<", 7, Operator::less},
    {"<=", 7, Operator::less_equal},    {">", 7, Operator::greater},
    {">=", 7, Operator::greater_equal}, {"<<", 8, Operator::shift_left},
    {">>", 8, Operator::shift_right},   {"+", 9, Operator::add},
    {"-", 9, Operator::subtract},       {"*", 10, Operator::multiply},
    {"/", 10, Operator::divide},        {"%", 10, Operator::modulus},
};

struct AssignmentOperator {
  const char* sign;
  Operator operation;
};
constexpr AssignmentOperator assignment_operators[] = {
    {"=", Operator::none},     {"+=", Operator::add},         {"-=", Operator::subtract},     {"*=", Operator::multiply},
    {"/=", Operator::divide},  {"%=", Operator::modulus},     {"&=", Operator::bit_and},      {"|=", Operator::bit_or},
    {"^=", Operator::bit_xor}, {"<<=", Operator::shift_left}, {">>=", Operator::shift_right},
};

}  // namespace

ExpressionPointer Parser::make(Expression::Kind kind, Location at, std::vector<ExpressionPointer> operands) {
  auto e = std::make_unique<Expression>();
  e->kind = kind, e->place = at;
  for (const ExpressionPointer& o : operands) e->depth = std::max(e->depth, o->depth + 1);
  e->operands = std::move(operands);
  if (e->depth > most_depth) refuse(at, fmt::format("an expression of more than {} levels", most_depth));
  return e;
}

ExpressionPointer Parser::expression() {
  ExpressionPointer first = assignment();
  if (!is(",")) return first;
  const Location at = first->place;
  std::vector<ExpressionPointer> parts;
  parts.push_back(std::move(first));
  while (accept(",")) parts.push_back(assignment());
  return make(Expression::Kind::comma, at, std::move(parts));
}

ExpressionPointer Parser::assignment() {
  const Nest nest(*this);
  ExpressionPointer left = conditional();
  if (now().kind != Token::Kind::sign) return left;
  for (const AssignmentOperator& o : assignment_operators) {
    if (!is(o.sign)) continue;
    const Location at = take().place;
    ExpressionPointer right = is("{") ? list() : assignment();
    auto e = make(Expression::Kind::assignment, at, std::move(left), std::move(right));
    e->operation = o.operation;
    return e;
  }
  return left;
}

ExpressionPointer Parser::conditional() {
  ExpressionPointer condition = binary(1);
  if (!is("?")) return condition;
  const Nest nest(*this);
  const Location at = take().place;
  ExpressionPointer yes = assignment();
  expect(":", "in '? :'");
  ExpressionPointer no = assignment();
  return make(Expression::Kind::conditional, at, std::move(condition), std::move(yes), std::move(no));
}

ExpressionPointer Parser::binary(int least) {
  ExpressionPointer left = unary();
  for (;;) {
    if (now().kind != Token::Kind::sign && now().kind != Token::Kind::name) return left;
    const BinaryOperator* found = nullptr;
    for (const BinaryOperator& o : binary_operators)
      if (is(o.sign)) found = &o;
    if (!found || found->precedence < least) return left;
    const Location at = take().place;
    ExpressionPointer right = binary(found->precedence + 1);
    auto e = make(Expression::Kind::binary, at, std::move(left), std::move(right));
    e->operation = found->operation;
    if (found->precedence <= 2) e->name = found->precedence == 1 ? "||" : "&&";
    left = std::move(e);
  }
}

ExpressionPointer Parser::unary() {
  const Location at = now().place;
  const Nest nest(*this);
  if (is("++") || is("--")) {
    const int direction = take().text == "++" ? 1 : -1;
    auto e = make(Expression::Kind::increment, at, unary());
    e->direction = direction;
    return e;
  }
  if (is("-") || is("~") || is("!") || is("not") || is("+")) {
    const std::string sign = take().text;
    auto e = make(Expression::Kind::unary, at, unary());
    if (sign == "-") e->operation = Operator::negate;
    if (sign == "~") e->operation = Operator::complement;
    if (sign == "!" || sign == "not") e->name = "!";
    if (sign == "+") e->name = "+";
    return e;
  }
  if (is("(") && at_type(1) && !ahead(2).is("(")) {  // (type) value
    take();
    const TypeName t = type();
    expect(")", "behind the type of a conversion");
    auto e = make(Expression::Kind::cast, at, is("{") ? list() : unary());
    e->type = t;
    return e;
  }
  return postfix();
}

ExpressionPointer Parser::postfix() {
  ExpressionPointer e = primary();
  for (;;) {
    const Location at = now().place;
    if (is("[") && !ahead(1).is("[")) {
      take();
      ExpressionPointer index = expression();
      expect("]", "behind an index");
      e = make(Expression::Kind::subscript, at, std::move(e), std::move(index));
    } else if (is(".")) {
      take();
      if (now().kind != Token::Kind::name) refuse(now().place, fmt::format("the name of a field is expected, not {}", shown()));
      std::string name = take().text;
      e = make(Expression::Kind::member, at, std::move(e));
      e->name = std::move(name);
    } else if (is("++") || is("--")) {
      const int direction = take().text == "++" ? 1 : -1;
      e = make(Expression::Kind::increment, at, std::move(e));
      e->direction = direction, e->postfix = true;
    } else {
      return e;
    }
  }
}

std::vector<ExpressionPointer> Parser::arguments(const char* close) {
  std::vector<ExpressionPointer> out;
  while (!is(close)) {
    out.push_back(is("{") ? list() : assignment());
    if (!accept(",")) break;
  }
  expect(close, "behind a list");
  return out;
}

ExpressionPointer Parser::list() {
  const Nest nest(*this);
  const Location at = take().place;
  return make(Expression::Kind::list, at, arguments("}"));
}

ExpressionPointer Parser::primary() {
  const Token& t = now();
  const Location at = t.place;
  switch (t.kind) {
    case Token::Kind::integer: {
      const std::string text = take().text;
      errno = 0;
      const unsigned long long value = std::strtoull(text.c_str(), nullptr, text.size() > 1 && (text[1] | 32) == 'x' ? 16 : 10);
      if (errno || value > std::numeric_limits<unsigned>::max() ||
          (value > 2147483648ULL && (text.size() < 2 || (text[1] | 32) != 'x')))
        diagnostics_.error(at, fmt::format("the integer {} is out of range", text.substr(0, 40)));
      auto e = make(Expression::Kind::integer, at);
      e->number = double(int(unsigned(value)));
      return e;
    }
    case Token::Kind::real: {
      auto e = make(Expression::Kind::real, at);
      e->number = std::strtod(take().text.c_str(), nullptr);
      return e;
    }
    case Token::Kind::text: {
      auto e = make(Expression::Kind::text, at);
      e->name = take().text;
      return e;
    }
    case Token::Kind::name: {
      const bool type_name = is_simple_type(t.text);
      if (!type_name && is_reserved(t.text))
        refuse(at, fmt::format("'{}' is a word of the language; a value is expected here", t.text));
      std::string name = take().text;
      if (!is("(")) {
        if (type_name) refuse(at, fmt::format("a value is expected here, not the type '{}'", name));
        auto e = make(Expression::Kind::name, at);
        e->name = std::move(name);
        return e;
      }
      take();
      auto e = make(Expression::Kind::call, at, arguments(")"));
      e->name = std::move(name);
      return e;
    }
    default: break;
  }
  if (accept("(")) {
    ExpressionPointer e = expression();
    expect(")", "to close '('");
    return e;
  }
  refuse(at, fmt::format("a value is expected here, not {}", shown()));
}

}  // namespace etendue::osl::syntax
