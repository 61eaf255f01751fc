// Parser: the constructs that make large descriptions possible: functions, files with parameters, list comprehensions,
// conditionals.

#include <fmt/format.h>

#include <algorithm>

#include "language/parser.h"

namespace etendue::language {

// Parses tree(height, radius = 1 m) = …, from the bracket on.
void Parser::function(Document& document, const Token& name) {
  Definition made{{name.text, name.at}, false, {}, true};
  try {
    parameters(made);
    if (!token_.is('=') || token_.first_in_line) unexpected(fmt::format("'=' after the parameters of '{}'", name.text));
    take();
    lost_ = false;
    made.value = expression();
    if (!may_be_defined(name)) return;
  } catch (const Failed&) {
    // The name is defined all the same, so that its uses are not reported as well.
    made.value.type = NodeType::bad;
    document.definitions.push_back(std::move(made));
    throw;
  }
  document.definitions.push_back(std::move(made));
}

void Parser::parameters(Definition& made) {
  const Lines lines(*this, true);
  const Location opened = take().at;
  open_ += '(';
  while (!token_.is(')')) {
    if (token_.type == TokenType::end) not_closed('(', opened);
    if (token_.type != TokenType::name || !is_name(token_.text)) unexpected("the name of a parameter");
    Parameter parameter;
    const Token name = take();
    parameter.name = {name.text, name.at};
    for (const Parameter& p : made.parameters)
      if (p.name.text == name.text)
        diagnostics_.add(Error(fmt::format("there is a parameter '{}' already", name.text), name.at));
    if (token_.is('=')) {
      take();
      parameter.standard = std::make_unique<Node>(expression());
    } else if (!made.parameters.empty() && made.parameters.back().standard) {
      diagnostics_.add(Error(fmt::format("'{}' needs a default, as a parameter before it has one", name.text), name.at));
    }
    made.parameters.push_back(std::move(parameter));
    if (token_.is(','))
      take();
    else if (!token_.is(')') && token_.type != TokenType::end)
      unexpected("',' or ')'");
  }
  open_.pop_back();
  take();
}

// Parses, after `include`: "file" with { param: value } as name.
void Parser::inclusion(Document& document) {
  Inclusion made;
  made.path = path_statement("the file to include, in quotes");
  try {
    conditions(made);
  } catch (const Failed&) {
    // Its names are defined all the same, so that their uses are not reported as well.
    made.replaced.clear();
    document.includes.push_back(std::move(made));
    throw;
  }
  document.includes.push_back(std::move(made));
}

// Parses: with { param: value } as name
void Parser::conditions(Inclusion& made) {
  if (token_.is_word("with") && lexer_.followed_by("{")) {
    take();
    // The block is parsed like that of a component. It must be complete: with some of the values only, wrong errors would
    // follow.
    Node block = component(Token{TokenType::name, 0, false, false, 0, {}, token_.at, 0});
    if (block.damaged) throw Failed{};
    for (size_t i = 0; i < block.children.size(); ++i)
      made.replaced.push_back({block.labels[i], true, std::move(block.children[i])});
  }
  if (token_.is_word("as") && !token_.first_in_line) {
    take();
    if (token_.type != TokenType::name || token_.first_in_line || !is_name(token_.text))
      unexpected("a name that stands before the names of the file");
    const Token name = take();
    made.name = {name.text, name.at};
  }
}

// Parses: if condition then value else value. `then` and `else` may begin new lines.
Node Parser::conditional() {
  const Level level(*this, token_.at);
  Node node;
  node.type = NodeType::conditional;
  node.at = take().at;
  const auto part = [&](const char* word) {
    node.children.push_back(expression());
    if (token_.is('=')) fail("values are compared by '==', not '='", token_.at);
    if (!token_.is_word(word)) unexpected(fmt::format("'{}' of the 'if' at {}", word, place(node.at, token_.at)));
    take();
  };
  part("then");
  part("else");
  node.children.push_back(expression());
  return node;
}

// Parses the clauses, from the first `for` after the entry of a list.
void Parser::comprehension(Node& list) {
  if (list.children.size() > 1) fail("a list by 'for' has one entry before it: put them in brackets of their own", token_.at);
  list.type = NodeType::comprehension;
  const Lines lines(*this, true);
  for (;;) {
    const bool loop = token_.is_word("for");
    if (!loop && !token_.is_word("if")) return;
    const Location at = take().at;
    Label label{{}, at};
    if (loop) {
      if (token_.type != TokenType::name || !is_name(token_.text)) unexpected("a name after 'for'");
      const Token name = take();
      for (const Label& before : list.labels)
        if (before.text == name.text)
          fail(fmt::format("there is a 'for {}' already, at {}", name.text, place(before.at, name.at)), name.at);
      label = {name.text, name.at};
      if (!token_.is_word("in")) unexpected(fmt::format("'in' after 'for {}'", name.text));
      take();
    }
    list.labels.push_back(std::move(label));
    // An "if … then" would be a conditional, and needs brackets here.
    list.children.push_back(loop ? expression() : disjunction());
    if (!loop && token_.is('=')) fail("values are compared by '==', not '='", token_.at);
  }
}

}  // namespace etendue::language
