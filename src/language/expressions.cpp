// Parser: expressions.

#include <fmt/format.h>

#include "parser.h"

namespace etendue::language {

Node Parser::expression() {
  const size_t begin = token_.begin;
  Node node = begins("if") ? conditional() : disjunction();
  node.begin = begin;  // includes brackets around the expression
  node.end = last_end_;
  return node;
}

bool Parser::joins() const {
  if (token_.type != TokenType::name) return false;
  for (const char* word : {"and", "or", "then", "else", "for", "if", "elif", "elseif", "elsif"})
    if (token_.text == word) return true;
  return false;
}

bool Parser::begins(std::string_view word) const {
  return token_.is_word(word) && !lexer_.ends_line() && !lexer_.followed_by("{}]),;:=<>!+*/^");
}

Node Parser::words(NodeType type, std::string_view word, Node (Parser::*operand)()) {
  Node left = (this->*operand)();
  if (!continues() || !token_.is_word(word)) return left;
  Node node;
  node.type = type;
  node.at = left.at;
  node.children.push_back(std::move(left));
  while (continues() && token_.is_word(word)) {
    node.labels.push_back({std::string(word), take().at});
    node.children.push_back((this->*operand)());
  }
  return node;
}

Node Parser::disjunction() { return words(NodeType::disjunction, "or", &Parser::conjunction); }

Node Parser::conjunction() { return words(NodeType::conjunction, "and", &Parser::inversion); }

Node Parser::inversion() {
  if (!begins("not")) return comparison();
  const Level level(*this, token_.at);
  Node node;
  node.type = NodeType::inversion;
  node.at = take().at;
  node.children.push_back(inversion());
  return node;
}

Node Parser::comparison() {
  const auto compares = [&] {
    constexpr char which[] = {symbols::equal, symbols::different, symbols::at_most, symbols::at_least, '<', '>'};
    return continues() && token_.type == TokenType::symbol &&
           std::string_view(which, sizeof(which)).find(token_.symbol) != std::string_view::npos;
  };
  Node left = range();
  if (!compares()) return left;
  Node node;
  node.type = NodeType::comparison;
  node.at = left.at;
  node.children.push_back(std::move(left));
  node.labels.push_back({symbol_text(token_.symbol), token_.at});
  take();
  node.children.push_back(range());
  if (compares()) fail("comparisons cannot be chained: write a < b and b < c", token_.at);
  return node;
}

Node Parser::range() {
  Node first = sum();
  if (!continues() || !token_.is(symbols::range)) return first;
  Node node;
  node.type = NodeType::range;
  node.at = first.at;
  node.labels.push_back({"..", take().at});
  if (token_.type == TokenType::number && token_.joined && token_.text.starts_with('.'))
    fail("a range is written with two dots: 0..3", node.labels.back().at);
  node.children.push_back(std::move(first));
  node.children.push_back(sum());
  return node;
}

// A chain such as a + b - c becomes one node, not a tree as deep as the chain is long.
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
  if (!token_.is('-')) return power();
  const Level level(*this, token_.at);
  Node node;
  node.type = NodeType::negation;
  node.at = take().at;
  node.children.push_back(unary());
  return node;
}

// Powers bind more tightly than a sign before them, and are right-associative: -2^2 is -(2^2), 2^3^2 is 2^(3^2), 2^-1 is a
// half.
Node Parser::power() {
  Node base = postfix();
  if (!continues() || !token_.is('^')) return base;
  const Level level(*this, token_.at);
  Node node;
  node.type = NodeType::power;
  node.at = base.at;
  node.labels.push_back({"^", token_.at});
  node.children.push_back(std::move(base));
  take();
  node.children.push_back(unary());
  return node;
}

// A value with an optional index and unit.
Node Parser::postfix() {
  const bool literal = token_.type == TokenType::number || token_.is('[') || token_.is('(');
  const bool list = token_.is('[');
  Node value = primary();
  if (!list) value = indexed(std::move(value));
  if (!literal || token_.type != TokenType::name || token_.first_in_line || joins()) return value;
  if (lexer_.followed_by(":") && !blocks_.empty() && open_.empty()) {
    report(fmt::format("expected ',' or a new line before '{}'", token_.text), token_.at);
    comma_told_ = true;
    return value;
  }
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

// An index into a list: points[3]. After a blank the bracket begins a separate item, and a comma is missing before it.
Node Parser::indexed(Node list) {
  if (list.type == NodeType::number || list.type == NodeType::string || list.type == NodeType::component) return list;
  constexpr int most = 16;
  for (int places = 0; token_.is('[') && token_.joined; ++places) {
    if (places == most) fail(fmt::format("lists have no more than {} levels", most), token_.at);
    const Level level(*this, token_.at);
    Node node;
    node.type = NodeType::index;
    node.at = list.at;
    const Location opened = token_.at;
    node.labels.push_back({"[", opened});
    const Lines lines(*this, true);
    take();
    open_ += '[';
    node.children.push_back(std::move(list));
    node.children.push_back(expression());
    if (token_.type == TokenType::end) not_closed('[', opened);
    if (!token_.is(']')) unexpected("']' after the index");
    open_.pop_back();
    take();
    list = std::move(node);
  }
  return list;
}

// An argument of a call: a value, or name = value.
Node Parser::argument() {
  if (token_.type != TokenType::name || !lexer_.followed_by_assignment()) return expression();
  Node node;
  node.type = NodeType::argument;
  const Token name = take();
  node.at = name.at;
  node.text = name.text;
  take();
  node.children.push_back(expression());
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
  // A superfluous closing bracket after an error follows from an opening bracket that was skipped.
  lost_ = lost_ || (wrong_ && (token_.is('}') || token_.is(']') || token_.is(')')));
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
  node.begin = name.begin;
  node.end = name.end;
  if (token_.is('{')) return component(name);
  if (misses_brace(name.text)) return component_without_brace(name);
  if (two_words(name)) {
    node = component(name);
    node.type = NodeType::bad;
    return node;
  }
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
  node.begin = token_.begin;
  // The lexer is positioned right after the '['.
  if (auto numbers = std::make_unique<Numbers>(); lexer_.read_numbers(*numbers)) {
    node.type = NodeType::numbers;
    node.numbers = std::move(numbers);
    token_.end = lexer_.position();
    take();
    node.end = last_end_;
    return node;
  }
  node.type = NodeType::list;
  const Location opened = take().at;
  items(node, ']', opened);
  node.end = last_end_;
  return node;
}

// Items between brackets; the opening bracket is already taken. In a list a new line separates items as a comma does, so that
// [1 (new line) -2] has two items; between the arguments of a call new lines are ignored.
void Parser::items(Node& node, char close, const Location& opened) {
  const bool is_list = close == ']';
  const char opening = is_list ? '[' : '(';
  const Lines lines(*this, !is_list);
  open_ += opening;
  bool whole = true;
  while (!token_.is(close)) {
    if (token_.type == TokenType::end) not_closed(opening, opened);
    node.children.push_back(is_list ? expression() : argument());
    if (is_list && token_.is_word("for") && (!token_.first_in_line || lexer_.followed_by_name("in"))) {
      comprehension(node);
      if (token_.type == TokenType::end) not_closed(opening, opened);
      if (!token_.is(close)) unexpected("'for', 'if' or ']'");
    } else if (token_.is(',')) {
      take();
    } else if (token_.type == TokenType::end) {
      not_closed(opening, opened);
    } else if (!token_.is(close) && !(is_list && token_.first_in_line)) {
      bool item = token_.type == TokenType::name ? !lexer_.followed_by(":") : token_.type == TokenType::number;
      if (token_.first_in_line) item = false;  // probably the ')' is missing
      lost_ = lost_ || !whole;
      if (!item) unexpected(fmt::format("',' or '{}'", close));
      // Continues as if the comma were there; only the first missing comma is reported.
      if (whole) report(fmt::format("expected ',' or '{}', not {}", close, token_.words()), token_.at);
      whole = false;
    }
  }
  open_.pop_back();
  take();
  if (!whole) node.type = NodeType::bad;
}

}  // namespace etendue::language
