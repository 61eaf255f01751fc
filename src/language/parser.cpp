// Parser: statements, component blocks, and recovery after errors.

#include "parser.h"

#include <fmt/format.h>

#include <utility>

#include "etendue/describe/registry.h"

namespace etendue::language {

Parser::Parser(const Source& source, Diagnostics& diagnostics, size_t begin)
    : diagnostics_(diagnostics), lexer_(source, diagnostics, begin), token_(lexer_.next()) {
  lexer_.set_quiet(&lost_);
}

Token Parser::take() {
  Token taken = std::move(token_);
  last_end_ = taken.end;
  last_may_be_list_ = taken.type == TokenType::name || taken.is(']') || taken.is(')');
  token_ = lexer_.next();
  return taken;
}

void Parser::report(const std::string& message, const Location& at) {
  if (!lost_) diagnostics_.add(Error(message, at));
  lost_ = wrong_ = true;
}

void Parser::fail(const std::string& message, const Location& at) {
  report(message, at);
  throw Failed{};
}

void Parser::unexpected(const std::string& expected) {
  if (token_.type == TokenType::bad) {
    lost_ = wrong_ = true;
    throw Failed{};
  }
  fail(fmt::format("expected {}, not {}{}", expected, token_.words(), meant()), token_.at);
}

// After an earlier error the closing bracket was probably skipped with it, so nothing is reported.
void Parser::not_closed(char bracket, const Location& opened) {
  if (!wrong_ && stranger_ && bracket == '{')
    diagnostics_.add(
        Error(fmt::format("a '}}' is missing before '{}': {}, whose '{{' is at {}, has no such member, but {} has",
                          stranger_->member, stranger_->inner, place(stranger_->inner_opened, stranger_->at), stranger_->outer),
              stranger_->at));
  else if (!wrong_)
    diagnostics_.add(Error(fmt::format("'{}' is never closed", bracket), opened));
  wrong_ = true;
  throw Abandoned{};
}

// Skips to a position where the next member or statement may start. A new line outside of brackets ends a statement, so that
// one mistake hides as little as possible.
void Parser::recover(bool in_block) {
  skip(std::exchange(open_, {}), in_block,
       [&] { return token_.first_in_line || token_.is(';') || (in_block && (token_.is('}') || token_.is(','))); });
}

// Skips tokens, including the contents of brackets that are open or are opened meanwhile.
void Parser::skip(std::string open, bool in_block, const std::function<bool()>& stops) {
  while (token_.type != TokenType::end && !(open.empty() && stops())) {
    if (token_.is('{') || token_.is('[') || token_.is('(')) {
      open += token_.symbol;
    } else if (token_.is('}')) {
      // A '}' also closes unclosed brackets within its block.
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
        const size_t before = document.definitions.size();
        statement(document);
        const bool separated = token_.is(';') || token_.first_in_line || token_.type == TokenType::end;
        // A definition with more text after it in its line was probably misread.
        if (!separated && document.definitions.size() > before) document.definitions.back().value.type = NodeType::bad;
        if (!token_.is(';')) require_separator("a new line or ';' after the statement");
      } catch (const Failed&) {
        if (token_.at == begin) take();  // avoids an endless loop
        recover(false);
        blocks_.clear();
      }
    }
  } catch (const Abandoned&) {
    document.whole = false;
  }
  return document;
}

void Parser::statement(Document& document) {
  static constexpr const char* known = "a statement (name = value, param, include, plugin, class or a component)";
  if (token_.is('}')) fail("this '}' closes nothing: there is one too many, or a '{' is missing", token_.at);
  if (token_.type != TokenType::name) unexpected(known);
  if (lexer_.followed_by(":")) return go_on_with_last(document);
  Token name = take();
  if (skip_foreign_word(name)) return statement(document);
  if (token_.is('=')) return definition(document, std::move(name), false);
  if (token_.is('(') && !token_.first_in_line) return function(document, name);
  if (token_.is('{') || misses_brace(name.text)) {
    lost_ = lost_ && !token_.is('{');
    document.components.push_back(token_.is('{') ? component(name) : component_without_brace(name));
    document.components.back().begin = name.begin;
    document.components.back().end = last_end_;
    return;
  }
  if (name.text == "param") {
    if (token_.type != TokenType::name) unexpected("the name of the param");
    Token parameter = take();
    if (!token_.is('=')) {
      // The name is defined, so that its uses are not reported.
      document.definitions.push_back({{parameter.text, parameter.at}, true, {}});
      document.definitions.back().value.type = NodeType::bad;
      unexpected("'=' and the default of the param");
    }
    return definition(document, std::move(parameter), true);
  }
  if (name.text == "include") {
    inclusion(document);
  } else if (name.text == "plugin" || (name.text == "class" && token_.type == TokenType::string)) {
    document.plugins.push_back(path_statement("the plugin's file, in quotes"));
  } else {
    // Probably a definition without its '=': the name is defined, so that its uses are not reported as well.
    Definition wrong{{name.text, name.at}, false, {}};
    wrong.value.type = NodeType::bad;
    document.definitions.push_back(std::move(wrong));
    if ((token_.type == TokenType::string || token_.type == TokenType::name) && !token_.first_in_line) {
      std::string near = suggestion(name.text, {"param", "include", "plugin", "class"});
      for (const char* word : {"import", "use", "using", "require", "load", "source"})
        if (name.text == word && token_.type == TokenType::string) near = " (here it is include \"file\")";
      if (!near.empty()) fail(fmt::format("unknown statement '{}'{}", name.text, near), name.at);
    }
    unexpected("'=' or '{' after '" + name.text + "'");
  }
}

// Whether a name may be defined; reports an error if not.
bool Parser::may_be_defined(const Token& name) {
  for (const char* reserved : {"true", "false", "none", "pi"})
    if (name.text == reserved) {
      diagnostics_.add(Error(fmt::format("'{}' is reserved and cannot be defined", reserved), name.at));
      return false;
    }
  if (is_name(name.text)) return true;
  diagnostics_.add(
      Error(fmt::format("'{}' cannot be defined here: a '.' stands between the name that a file was included as and "
                        "a name of that file",
                        name.text),
            name.at));
  return false;
}

void Parser::definition(Document& document, Token name, bool parameter) {
  take();  // '='
  lost_ = false;
  return valued(document, std::move(name), parameter);
}

// Parses the value after the '='.
void Parser::valued(Document& document, Token name, bool parameter) {
  Definition made{{name.text, name.at, name.begin}, parameter, {}};
  if (!may_be_defined(name)) {
    expression();
    return;
  }
  try {
    require_value_before_comment();
    made.value = expression();
  } catch (const Failed&) {
    // The name is defined all the same, so that its uses are not reported as well.
    made.value.type = NodeType::bad;
    document.definitions.push_back(std::move(made));
    throw;
  }
  document.definitions.push_back(std::move(made));
}

Label Parser::path_statement(const char* what) {
  if (token_.type != TokenType::string) unexpected(what);
  const Token path = take();
  return {path.text, path.at, path.begin};
}

// A member outside of any block: probably the last block was closed too early by a superfluous '}'. Its members are parsed.
void Parser::go_on_with_last(Document& document) {
  Node* last = nullptr;
  for (Node& node : document.components) last = !last || last->at.line < node.at.line ? &node : last;
  for (Definition& definition : document.definitions)
    if (definition.value.type == NodeType::component && (!last || last->at.line < definition.value.at.line))
      last = &definition.value;
  const ClassInfo* info = last ? Registry::instance().find(last->text) : nullptr;
  if (!last || !last_close_.known() || (info && !info->find(token_.text))) return definition_by_colon(document);
  report(fmt::format("a '}}' too many: here {} ends, but '{}' follows at {}", last->text, token_.text,
                     place(token_.at, last_close_)),
         last_close_);
  last->damaged = true;
  Node rest;
  rest.text = last->text;
  const Lines lines(*this, false);
  members(rest, token_.at);
}

// Parses a component; the current token is the '{', or, if that is missing, the first token after it.
Node Parser::component(const Token& class_name, bool braced) {
  const Location opened = token_.at;
  const Level level(*this, opened);
  const Lines lines(*this, false);
  std::string outside = std::exchange(open_, {});
  Node node;
  node.type = NodeType::component;
  node.at = class_name.at;
  node.text = class_name.text;
  if (braced) node.inside = take().end;
  members(node, opened);
  open_ = std::move(outside);
  return node;
}

// Parses the members from after the '{' to the '}'.
void Parser::members(Node& node, const Location& opened) {
  Seen seen;
  blocks_.push_back({node.text, opened});
  const size_t level = blocks_.size();
  while (!token_.is('}')) {
    if (token_.type == TokenType::end) not_closed('{', opened);
    const Location begin = token_.at;
    try {
      member(node, seen);
    } catch (const Failed&) {
      blocks_.resize(level);
      node.damaged = true;
      if (token_.at == begin) take();  // avoids an endless loop
      recover(true);
      if (token_.is(',') || token_.is(';')) take();
    }
  }
  last_close_ = take().at;
  blocks_.pop_back();
}

void Parser::member(Node& component, Seen& seen) {
  if (misses_bracket(component)) throw Failed{};
  if (token_.type != TokenType::name) unexpected("a member name or '}'");
  const Token name = take();
  if (!token_.is(':')) {
    // The value is unknown, but the member counts as written.
    if (seen.emplace(name.text, name.at).second) {
      component.labels.push_back({name.text, name.at});
      component.children.emplace_back().type = NodeType::bad;
    }
    unexpected(fmt::format("':' after the member name '{}'", name.text));
  }
  lost_ = comma_told_ = false;
  take();
  note_stranger(name);
  const auto [first, fresh] = seen.emplace(name.text, name.at);
  if (!fresh)
    diagnostics_.add(Error(fmt::format("'{}' is already set at {}", name.text, place(first->second, name.at)), name.at));
  Node value;
  value.type = NodeType::bad;
  const size_t index = component.children.size();
  component.labels.push_back({name.text, name.at, name.begin});
  component.children.push_back(std::move(value));
  bool good = false;
  const auto leave = [&] {
    if (fresh) return;
    component.labels.pop_back();
    component.children.pop_back();
  };
  try {
    good = member_value(component, index);
  } catch (const Failed&) {
    leave();
    throw;
  }
  if (!good) component.children[index] = {}, component.children[index].type = NodeType::bad;
  leave();
}

// Parses the value of a member and its separator; the member counts as written even if the value has errors. False: the value
// was read, but probably not as it was meant.
bool Parser::member_value(Node& component, size_t index) {
  require_value_before_comment();
  Node value = expression();
  component.children[index] = std::move(value);
  if (token_.is(',')) {
    take();
  } else if (token_.is(']') || token_.is(')')) {
    report(fmt::format("this '{}' closes nothing: is a '{}' missing before the value of '{}'?", token_.symbol,
                       token_.is(']') ? '[' : '(', component.labels[index].text),
           token_.at);
    component.damaged = true;
    skip_stray_bracket();
    return false;
  } else if (!token_.is('}') && !token_.first_in_line && token_.type != TokenType::end) {
    component.damaged = true;
    if (token_.type != TokenType::name || !lexer_.followed_by(":")) {
      component.children[index] = {};
      component.children[index].type = NodeType::bad;
      require_separator("',' or a new line before the next member");
    }
    // The next member can be parsed as if the comma were there.
    if (!comma_told_)
      report(fmt::format("expected ',' or a new line before the next member, not {}", token_.words()), token_.at);
  }
  return true;
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
