#include "parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <limits>
#include <optional>

namespace etendue::osl::syntax {

namespace {

/// Ends the statement or declaration that is being parsed, after its error was reported.
struct Abandon {};

constexpr std::array simple_types = {"int", "float", "color", "point", "vector", "normal", "matrix", "string", "void"};

// Names of the language that cannot be variables; those of C that are reserved for the future among them.
constexpr std::array reserved = {
    "and",      "break",       "closure",    "color",   "continue", "do",      "else",      "emit",    "float",   "for",
    "if",       "illuminance", "illuminate", "int",     "matrix",   "normal",  "not",       "or",      "output",  "point",
    "public",   "return",      "string",     "struct",  "vector",   "void",    "while",     "bool",    "case",    "catch",
    "char",     "class",       "const",      "delete",  "default",  "double",  "enum",      "extern",  "false",   "friend",
    "goto",     "inline",      "long",       "new",     "operator", "private", "protected", "short",   "signed",  "sizeof",
    "static",   "switch",      "template",   "this",    "throw",    "true",    "try",       "typedef", "uniform", "union",
    "unsigned", "varying",     "virtual",    "volatile"};

bool contains(const auto& list, const std::string& word) {
  return std::any_of(list.begin(), list.end(), [&](const char* w) { return word == w; });
}

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

class Parser {
 public:
  Parser(std::span<const Token> tokens, Diagnostics& d) : tokens_(tokens), diagnostics_(d) {}

  File file();
  std::shared_ptr<FunctionDeclaration> signature();

 private:
  // Tokens
  const Token& now() const { return tokens_[at_]; }
  const Token& ahead(std::size_t n) const { return tokens_[std::min(at_ + n, tokens_.size() - 1)]; }
  bool is(const char* text) const { return now().is(text); }
  bool ended() const { return now().kind == Token::Kind::end; }
  Token take() {
    const Token& t = tokens_[at_];
    if (at_ + 1 < tokens_.size()) ++at_;
    return t;
  }
  bool accept(const char* text) {
    if (!is(text)) return false;
    take();
    return true;
  }
  void expect(const char* text, const char* where);
  [[noreturn]] void refuse(Location at, const std::string& text) {
    diagnostics_.error(at, text);
    throw Abandon{};
  }
  std::string shown() const { return ended() ? std::string("the end of the text") : "'" + now().text.substr(0, 40) + "'"; }
  Token identifier(const char* what);
  void skip_statement();

  /// Counts how deeply the parser calls itself.
  struct Nest {
    Parser& parser;
    explicit Nest(Parser& p) : parser(p) {
      if (++parser.nesting_ > most_nesting) {
        --parser.nesting_;
        parser.refuse(parser.now().place, fmt::format("this nests more than {} deep", most_nesting));
      }
    }
    ~Nest() { --parser.nesting_; }
  };

  // Declarations
  bool at_type(std::size_t n = 0) const;
  TypeName type();
  std::vector<Declarator> metadata();
  std::vector<Declarator> parameters(bool of_shader, FunctionDeclaration* variadic);
  void array_length(Declarator&);
  Declarator declarator(const TypeName&);
  StatementPointer declaration();
  StatementPointer structure();
  StatementPointer function(const TypeName& result, bool array);
  bool at_shader() const;
  std::unique_ptr<ShaderDeclaration> shader();

  // Statements
  StatementPointer statement();
  StatementPointer block();
  StatementPointer branch();
  StatementPointer loop();
  StatementPointer make(Statement::Kind kind, Location at) const {
    auto s = std::make_unique<Statement>();
    s->kind = kind, s->place = at;
    return s;
  }

  // Expressions
  ExpressionPointer expression();  ///< with commas
  ExpressionPointer assignment();
  ExpressionPointer conditional();
  ExpressionPointer binary(int least);
  ExpressionPointer unary();
  ExpressionPointer postfix();
  ExpressionPointer primary();
  ExpressionPointer list();
  std::vector<ExpressionPointer> arguments(const char* close);
  ExpressionPointer make(Expression::Kind, Location, std::vector<ExpressionPointer> = {});
  template <class... Parts>
  ExpressionPointer make(Expression::Kind kind, Location at, ExpressionPointer first, Parts... rest) {
    std::vector<ExpressionPointer> parts;
    parts.push_back(std::move(first));
    (parts.push_back(std::move(rest)), ...);
    return make(kind, at, std::move(parts));
  }

  std::span<const Token> tokens_;
  Diagnostics& diagnostics_;
  std::size_t at_ = 0;
  int nesting_ = 0;
};

void Parser::expect(const char* text, const char* where) {
  if (!accept(text)) refuse(now().place, fmt::format("'{}' is expected {}, not {}", text, where, shown()));
}

Token Parser::identifier(const char* what) {
  if (now().kind != Token::Kind::name) refuse(now().place, fmt::format("{} is expected, not {}", what, shown()));
  if (contains(reserved, now().text))
    refuse(now().place, fmt::format("'{}' is a word of the language and cannot be {}", now().text, what));
  return take();
}

/// Goes behind the next semicolon or closed block, or before the brace that closes this one.
void Parser::skip_statement() {
  int open = 0;
  while (!ended()) {
    if (is("{")) {
      ++open;
    } else if (is("}")) {
      if (open == 0) return;
      if (--open == 0) {
        take();
        return;
      }
    } else if (is(";") && open == 0) {
      take();
      return;
    }
    take();
  }
}

// ---- declarations

bool Parser::at_type(std::size_t n) const {
  const Token& t = ahead(n);
  return t.kind == Token::Kind::name && (contains(simple_types, t.text) || t.text == "closure");
}

TypeName Parser::type() {
  TypeName t;
  t.place = now().place;
  if (accept("closure")) t.closure = true;
  accept("struct");  // C's way to say it
  if (now().kind != Token::Kind::name) refuse(now().place, fmt::format("a type is expected, not {}", shown()));
  if (!contains(simple_types, now().text) && contains(reserved, now().text))
    refuse(now().place, fmt::format("'{}' is no type", now().text));
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
  static constexpr std::array kinds = {"shader", "surface", "displacement", "volume", "light"};
  return now().kind == Token::Kind::name && contains(kinds, now().text) && ahead(1).kind == Token::Kind::name &&
         (ahead(2).is("(") || ahead(2).is("["));
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

// ---- statements

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
        (ahead(1).kind == Token::Kind::name && !contains(reserved, word) && !contains(reserved, ahead(1).text)))
      return declaration();
  }
  auto s = make(Statement::Kind::expression, at);
  s->expression = expression();
  expect(";", "behind a statement");
  return s;
}

// ---- expressions

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
      const bool type_name = contains(simple_types, t.text);
      if (!type_name && contains(reserved, t.text))
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

}  // namespace

}  // namespace etendue::osl::syntax

namespace etendue::osl {

syntax::File parse(std::span<const Token> tokens, Diagnostics& diagnostics) {
  return syntax::Parser(tokens, diagnostics).file();
}

std::shared_ptr<syntax::FunctionDeclaration> parse_signature(const std::string& text) {
  Diagnostics diagnostics(1);
  const std::vector<Token> tokens = cut(text, {intern("the library"), 0, 0});
  try {
    return syntax::Parser(tokens, diagnostics).signature();
  } catch (const syntax::Abandon&) {
  } catch (const Diagnostics::Stop&) {
  }
  throw Error(fmt::format("the signature '{}': {}", text, diagnostics.list.empty() ? "wrong" : diagnostics.list[0].text));
}

}  // namespace etendue::osl
