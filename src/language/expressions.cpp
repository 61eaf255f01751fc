// Expressions.

#include <fmt/format.h>

#include "language/parser.h"

namespace etendue::language {

// Chains such as a + b - c become one node, not a tree that is as deep as the chain is long.
Node Parser::chain(NodeType type, char first, char second, Node (Parser::*operand)()) {
  Node left = (this->*operand)();
  if (!continues() || !(token_.is(first) || token_.is(second))) return left;
  Node node;
  node.type = type;
  node.at = left.at;
  node.children.push_back(std::move(left));
  while (continues() && (token_.is(first) || token_.is(second))) {
    node.labels.push_back({std::string(1, token_.symbol), token_.at});
    take();
    node.children.push_back((this->*operand)());
  }
  return node;
}

Node Parser::sum() { return chain(NodeType::sum, '+', '-', &Parser::product); }

Node Parser::product() { return chain(NodeType::product, '*', '/', &Parser::unary); }

Node Parser::unary() {
  if (!token_.is('-')) return postfix();
  const Level level(*this, token_.at);
  Node node;
  node.type = NodeType::negation;
  node.at = take().at;
  node.children.push_back(unary());
  return node;
}

// A value and its unit.
Node Parser::postfix() {
  const bool literal = token_.type == TokenType::number || token_.is('[') || token_.is('(');
  Node value = primary();
  if (!literal || token_.type != TokenType::name || token_.first_in_line) return value;
  Token unit = take();
  if (token_.is(':') || token_.is('=') || token_.is('{') || token_.is('('))
    fail(fmt::format("expected ',' or a new line before '{}'", unit.text), unit.at);
  Node node;
  node.type = NodeType::unit;
  node.at = value.at;
  node.labels.push_back({std::move(unit.text), unit.at});
  node.children.push_back(std::move(value));
  return node;
}

Node Parser::primary() {
  Node node;
  node.at = token_.at;
  switch (token_.type) {
    case TokenType::number:
      node.type = NodeType::number;
      node.number = take().number;
      return node;
    case TokenType::string:
      node.type = NodeType::string;
      node.text = take().text;
      return node;
    case TokenType::name: return named(take());
    default: break;
  }
  if (token_.is('[')) return list();
  if (!token_.is('(')) unexpected("a value");
  const Level level(*this, token_.at);
  const Location opened = take().at;
  const Lines lines(*this, true);
  open_ += '(';
  node = expression();
  if (token_.type == TokenType::end) not_closed('(', opened);
  if (!token_.is(')')) unexpected("')'");
  open_.pop_back();
  take();
  return node;
}

Node Parser::named(const Token& name) {
  Node node;
  node.at = name.at;
  if (token_.is('{')) return component(name);
  if (token_.is('(') && continues()) {
    const Level level(*this, token_.at);
    node.type = NodeType::call;
    node.text = name.text;
    const Location opened = take().at;
    items(node, ')', opened);
    return node;
  }
  if (name.text == "none") return node;
  node.type = name.text == "true" || name.text == "false" ? NodeType::boolean : NodeType::name;
  node.number = name.text == "true";
  node.text = name.text;
  return node;
}

Node Parser::list() {
  const Level level(*this, token_.at);
  Node node;
  node.at = token_.at;
  // The lexer stands right behind the '['.
  if (auto numbers = std::make_unique<Numbers>(); lexer_.read_numbers(*numbers)) {
    node.type = NodeType::numbers;
    node.numbers = std::move(numbers);
    take();
    return node;
  }
  node.type = NodeType::list;
  const Location opened = take().at;
  items(node, ']', opened);
  return node;
}

// Items between brackets, the opening one being taken already. In a list a new line separates as a comma does, so that
// [1 (new line) -2] has two items; between the arguments of a call new lines mean nothing.
void Parser::items(Node& node, char close, const Location& opened) {
  const bool is_list = close == ']';
  const char opening = is_list ? '[' : '(';
  const Lines lines(*this, !is_list);
  open_ += opening;
  while (!token_.is(close)) {
    if (token_.type == TokenType::end) not_closed(opening, opened);
    node.children.push_back(expression());
    if (token_.is(',')) {
      take();
    } else if (token_.type == TokenType::end) {
      not_closed(opening, opened);
    } else if (!token_.is(close) && !(is_list && token_.first_in_line)) {
      unexpected(fmt::format("',' or '{}'", close));
    }
  }
  open_.pop_back();
  take();
}

}  // namespace etendue::language
