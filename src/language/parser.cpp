// Statements and component blocks, and going on after errors.

#include "language/parser.h"

#include <fmt/format.h>

#include <utility>

namespace etendue::language {

Parser::Parser(const Source& source, Diagnostics& diagnostics, size_t begin)
    : diagnostics_(diagnostics), lexer_(source, diagnostics, begin), token_(lexer_.next()) {}

Token Parser::take() {
  Token taken = std::move(token_);
  token_ = lexer_.next();
  return taken;
}

void Parser::fail(const std::string& message, const Location& at) {
  diagnostics_.add(Error(message, at));
  throw Failed{};
}

void Parser::unexpected(const std::string& expected) {
  if (token_.type == TokenType::bad) throw Failed{};
  fail(fmt::format("expected {}, not {}", expected, token_.words()), token_.at);
}

void Parser::not_closed(char bracket, const Location& opened) {
  diagnostics_.add(Error(fmt::format("'{}' is never closed", bracket), opened));
  throw Abandoned{};
}

// Skips to where the next member or statement may start. Brackets that are open, or are opened on the way, are skipped
// with what they hold; a new line ends a statement outside of them, so that one mistake hides as little as possible.
void Parser::recover(bool in_block) {
  std::string open = std::exchange(open_, {});
  while (token_.type != TokenType::end) {
    if (open.empty()) {
      if (token_.first_in_line || token_.is(';')) return;
      if (in_block && (token_.is('}') || token_.is(','))) return;
    }
    if (token_.is('{') || token_.is('[') || token_.is('(')) {
      open += token_.symbol;
    } else if (token_.is('}')) {
      // Closes whatever stands unclosed inside of its block as well.
      const size_t block = open.rfind('{');
      open.resize(block == std::string::npos ? 0 : block);
      if (block == std::string::npos && in_block) return;
    } else if ((token_.is(']') && open.ends_with('[')) || (token_.is(')') && open.ends_with('('))) {
      open.pop_back();
    }
    take();
  }
}

void Parser::require_separator(const char* what) {
  if (token_.first_in_line || token_.type == TokenType::end) return;
  unexpected(what);
}

Document Parser::document() {
  Document document;
  try {
    while (token_.type != TokenType::end) {
      if (token_.is(';')) {
        take();
        continue;
      }
      const Location begin = token_.at;
      try {
        statement(document);
        if (!token_.is(';')) require_separator("a new line or ';' after the statement");
      } catch (const Failed&) {
        if (token_.at == begin) take();  // never stand still
        recover(false);
      }
    }
  } catch (const Abandoned&) {
    document.whole = false;
  }
  return document;
}

void Parser::statement(Document& document) {
  static constexpr const char* known = "a statement (name = value, param, include, plugin or a component)";
  if (token_.type != TokenType::name) unexpected(known);
  Token name = take();
  if (token_.is('=')) return definition(document, std::move(name), false);
  if (token_.is('{')) {
    document.components.push_back(component(name));
    return;
  }
  if (name.text == "param") {
    if (token_.type != TokenType::name) unexpected("the name of the param");
    Token parameter = take();
    if (!token_.is('=')) unexpected("'=' and the default of the param");
    return definition(document, std::move(parameter), true);
  }
  if (name.text == "include") {
    document.includes.push_back(path_statement("the file to include, in quotes"));
  } else if (name.text == "plugin") {
    document.plugins.push_back(path_statement("the plugin's file, in quotes"));
  } else {
    // Most likely a definition without its '=': the name is known then, or every use of it would be reported as well.
    Definition wrong{{name.text, name.at}, false, {}};
    wrong.value.type = NodeType::bad;
    document.definitions.push_back(std::move(wrong));
    if ((token_.type == TokenType::string || token_.type == TokenType::name) && !token_.first_in_line) {
      const std::string near = suggestion(name.text, {"param", "include", "plugin"});
      if (!near.empty()) fail(fmt::format("unknown statement '{}'{}", name.text, near), name.at);
    }
    unexpected("'=' or '{' after '" + name.text + "'");
  }
}

void Parser::definition(Document& document, Token name, bool parameter) {
  take();  // '='
  Definition made{{name.text, name.at}, parameter, {}};
  for (const char* reserved : {"true", "false", "none", "pi"})
    if (name.text == reserved) {
      diagnostics_.add(Error(fmt::format("'{}' has a fixed meaning and cannot be defined", reserved), name.at));
      expression();
      return;
    }
  try {
    made.value = expression();
  } catch (const Failed&) {
    // The name is known all the same, or every use of it would be reported as well.
    made.value.type = NodeType::bad;
    document.definitions.push_back(std::move(made));
    throw;
  }
  document.definitions.push_back(std::move(made));
}

Label Parser::path_statement(const char* what) {
  if (token_.type != TokenType::string) unexpected(what);
  const Token path = take();
  return {path.text, path.at};
}

// At the '{'.
Node Parser::component(const Token& class_name) {
  const Location opened = token_.at;
  const Level level(*this, opened);
  const Lines lines(*this, false);
  std::string outside = std::exchange(open_, {});
  Node node;
  node.type = NodeType::component;
  node.at = class_name.at;
  node.text = class_name.text;
  std::unordered_map<std::string, Location> seen;
  take();
  while (!token_.is('}')) {
    if (token_.type == TokenType::end) not_closed('{', opened);
    const Location begin = token_.at;
    try {
      member(node, seen);
    } catch (const Failed&) {
      if (token_.at == begin) take();  // never stand still
      recover(true);
      if (token_.is(',') || token_.is(';')) take();
    }
  }
  take();
  open_ = std::move(outside);
  return node;
}

void Parser::member(Node& component, std::unordered_map<std::string, Location>& seen) {
  if (token_.type != TokenType::name) unexpected("a member name or '}'");
  const Token name = take();
  const auto [first, fresh] = seen.emplace(name.text, name.at);
  if (!fresh)
    diagnostics_.add(Error(fmt::format("'{}' is already set at {}", name.text, place(first->second, name.at)), name.at));
  Node value;
  value.type = NodeType::bad;
  size_t index = component.children.size();
  if (fresh) {  // counts as written even when its value cannot be read
    component.labels.push_back({name.text, name.at});
    component.children.push_back(std::move(value));
  }
  if (!token_.is(':')) unexpected(fmt::format("':' after the member name '{}'", name.text));
  take();
  value = expression();
  if (fresh) component.children[index] = std::move(value);
  if (token_.is(',')) {
    take();
  } else if (!token_.is('}')) {
    require_separator("',' or a new line before the next member");
  }
}

Node Parser::lone_expression() {
  Node node = expression();
  if (token_.type != TokenType::end) unexpected("the end of the expression");
  return node;
}

Document parse_document(const Source& source, Diagnostics& diagnostics) { return Parser(source, diagnostics).document(); }

std::unique_ptr<Node> parse_expression(const Source& source, Diagnostics& diagnostics, size_t begin) {
  try {
    Parser parser(source, diagnostics, begin);
    return std::make_unique<Node>(parser.lone_expression());
  } catch (const Parser::Failed&) {
  } catch (const Parser::Abandoned&) {
  }
  return nullptr;
}

}  // namespace etendue::language
