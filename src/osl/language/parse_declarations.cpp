// Declarations: structures, functions, variables, the shader and its parameters, metadata.

#include <algorithm>
#include <array>

#include "parse_steps.h"

namespace etendue::osl::syntax {

bool Parser::at_type(std::size_t n) const {
  const Token& t = ahead(n);
  return t.kind == Token::Kind::name && (is_simple_type(t.text) || t.text == "closure");
}

TypeName Parser::type() {
  TypeName t;
  t.place = now().place;
  if (accept("closure")) t.closure = true;
  accept("struct");  // C's way to say it
  if (now().kind != Token::Kind::name) refuse(now().place, fmt::format("a type is expected, not {}", shown()));
  if (!is_simple_type(now().text) && is_reserved(now().text)) refuse(now().place, fmt::format("'{}' is no type", now().text));
  t.name = take().text;
  return t;
}

std::vector<Declarator> Parser::metadata() {
  std::vector<Declarator> list;
  if (!(is("[") && ahead(1).is("["))) return list;
  take(), take();
  while (!is("]")) {
    const TypeName t = type();
    Declarator d;
    d.type = t;
    d.place = now().place;
    if (now().kind != Token::Kind::name)
      refuse(now().place, fmt::format("the name of a metadatum is expected, not {}", shown()));
    d.name = take().text;
    array_length(d);
    expect("=", "in metadata");
    d.initial = is("{") ? this->list() : conditional();
    list.push_back(std::move(d));
    if (!accept(",")) break;
  }
  expect("]", "at the end of metadata");
  expect("]", "at the end of metadata");
  return list;
}

void Parser::array_length(Declarator& d) {
  if (!is("[") || ahead(1).is("[")) return;
  take();
  d.array = true;
  if (!is("]")) d.length = conditional();
  expect("]", "behind an array's length");
  if (is("[") && !ahead(1).is("[")) refuse(now().place, "arrays of arrays do not exist in the language");
}

Declarator Parser::declarator(const TypeName& t) {
  Declarator d;
  d.type = t;
  const Token name = identifier("a name");
  d.name = name.text, d.place = name.place;
  array_length(d);
  if (accept("=")) d.initial = is("{") ? list() : assignment();
  return d;
}

std::vector<Declarator> Parser::parameters(bool of_shader, FunctionDeclaration* variadic) {
  constexpr std::size_t most_parameters = 10'000;
  std::vector<Declarator> out;
  expect("(", "before parameters");
  while (!is(")")) {
    const bool output = accept("output");
    if (variadic && accept("...")) {
      variadic->variadic = true, variadic->output_variadic = output;
      break;
    }
    TypeName t = type();
    Declarator d = declarator(t);
    d.output = output;
    d.metadata = metadata();
    if (of_shader && !d.initial) diagnostics_.error(d.place, fmt::format("the parameter '{}' has no default", d.name));
    if (!of_shader && d.initial)
      diagnostics_.error(d.place, fmt::format("the parameter '{}' of a function cannot have a default", d.name));
    out.push_back(std::move(d));
    if (out.size() > most_parameters) refuse(now().place, fmt::format("more than {} parameters", most_parameters));
    if (!accept(",")) break;
  }
  expect(")", "behind parameters");
  return out;
}

StatementPointer Parser::structure() {
  auto s = make(Statement::Kind::structure, take().place);  // struct
  s->structure = std::make_shared<StructDeclaration>();
  const Token name = identifier("the name of a structure");
  s->structure->name = name.text, s->structure->place = name.place;
  expect("{", "in a structure");
  while (!is("}")) {
    const TypeName t = type();
    do {
      Declarator d = declarator(t);
      if (d.initial) diagnostics_.error(d.place, "a field cannot have an initial value");
      s->structure->fields.push_back(std::move(d));
    } while (accept(","));
    expect(";", "behind a field");
  }
  take();
  accept(";");
  return s;
}

StatementPointer Parser::function(const TypeName& result, bool array) {
  auto s = make(Statement::Kind::function, now().place);
  s->function = std::make_shared<FunctionDeclaration>();
  FunctionDeclaration& f = *s->function;
  const Token name = identifier("the name of a function");
  f.result = result, f.result_array = array, f.name = name.text, f.place = name.place;
  f.parameters = parameters(false, nullptr);
  f.metadata = metadata();
  if (!accept(";")) {
    if (!is("{")) refuse(now().place, fmt::format("the body of the function '{}' is expected, not {}", f.name, shown()));
    f.body = block();
  }
  return s;
}

/// A type, then variables or a function.
StatementPointer Parser::declaration() {
  accept("public");
  const TypeName t = type();
  bool result_array = false;
  if (is("[")) {  // float[3] f(): refused by the checker with a reason
    Declarator d;
    array_length(d);
    result_array = true;
  }
  if (ahead(1).is("(")) return function(t, result_array);
  auto s = make(Statement::Kind::variables, t.place);
  do {
    s->variables.push_back(declarator(t));
  } while (accept(","));
  expect(";", "behind a declaration");
  return s;
}

bool Parser::at_shader() const {
  static constexpr std::array<std::string_view, 5> kinds = {"shader", "surface", "displacement", "volume", "light"};
  return now().kind == Token::Kind::name && std::ranges::find(kinds, now().text) != kinds.end() &&
         ahead(1).kind == Token::Kind::name && (ahead(2).is("(") || ahead(2).is("["));
}

std::unique_ptr<ShaderDeclaration> Parser::shader() {
  auto s = std::make_unique<ShaderDeclaration>();
  const std::string kind = take().text;
  s->kind = kind == "surface"        ? Shader::Kind::surface
            : kind == "displacement" ? Shader::Kind::displacement
            : kind == "volume"       ? Shader::Kind::volume
            : kind == "light"        ? Shader::Kind::light
                                     : Shader::Kind::shader;
  const Token name = identifier("the shader's name");
  s->name = name.text, s->place = name.place;
  s->metadata = metadata();
  s->parameters = parameters(true, nullptr);
  if (auto more = metadata(); !more.empty()) std::move(more.begin(), more.end(), std::back_inserter(s->metadata));
  if (!is("{")) refuse(now().place, fmt::format("the shader's body is expected, not {}", shown()));
  s->body = block();
  return s;
}

File Parser::file() {
  File file;
  while (!ended()) {
    try {
      if (accept(";")) continue;
      if (at_shader()) {
        const Location at = now().place;
        auto s = shader();
        if (file.shader)
          diagnostics_.error(at, fmt::format("a second shader, '{}': a file has one", s->name));
        else
          file.shader = std::move(s);
        continue;
      }
      StatementPointer s = is("struct") && ahead(2).is("{") ? structure() : declaration();
      if (s->kind == Statement::Kind::variables) {
        diagnostics_.error(s->place, "variables can be declared in a shader or a function only");
        continue;
      }
      (file.shader ? file.after : file.before).push_back(std::move(s));
    } catch (const Abandon&) {
      const std::size_t before = at_;
      skip_statement();
      if (is("}")) take();
      if (at_ == before) take();
    }
  }
  return file;
}

std::shared_ptr<FunctionDeclaration> Parser::signature() {
  auto f = std::make_shared<FunctionDeclaration>();
  f->result = type();
  f->place = now().place;
  f->name = take().text;
  f->parameters = parameters(false, f.get());
  return f;
}

}  // namespace etendue::osl::syntax
