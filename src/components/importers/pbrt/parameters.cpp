#include "parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue::pbrt {

namespace {

enum class Holds : unsigned char { numbers, strings, truths, either };
struct Type {
  std::string_view name;
  Holds holds;
};
// Types of pbrt v3 and v4, and older spellings.
constexpr Type types[] = {{"float", Holds::numbers},   {"integer", Holds::numbers},  {"bool", Holds::truths},
                          {"string", Holds::strings},  {"texture", Holds::strings},  {"point", Holds::numbers},
                          {"point2", Holds::numbers},  {"point3", Holds::numbers},   {"vector", Holds::numbers},
                          {"vector2", Holds::numbers}, {"vector3", Holds::numbers},  {"normal", Holds::numbers},
                          {"normal3", Holds::numbers}, {"rgb", Holds::numbers},      {"color", Holds::numbers},
                          {"xyz", Holds::numbers},     {"blackbody", Holds::either}, {"spectrum", Holds::either}};

/// Null: the type is unknown and version 3 ignores the parameter.
const Type* type_of(const Parameter& p, Importing* lenient) {
  std::vector<std::string> known;
  for (const Type& t : types) {
    if (t.name == p.type) return &t;
    known.emplace_back(t.name);
  }
  if (lenient) {
    lenient->inexact(fmt::format("there is no parameter type '{}'{}: '{}' is left out, as by version 3 of pbrt", p.type,
                                 suggestion(p.type, known), p.name),
                     p.at);
    return nullptr;
  }
  throw Error(fmt::format("there is no parameter type '{}'{}", p.type, suggestion(p.type, known)), p.at);
}

/// Splits "float radius" into type and name.
void name_parameter(Parameter& p, std::string_view declaration) {
  const std::string_view space = " \t";
  const size_t begin = declaration.find_first_not_of(space);
  const size_t type_end = begin == declaration.npos ? begin : declaration.find_first_of(space, begin);
  const size_t name = type_end == declaration.npos ? type_end : declaration.find_first_not_of(space, type_end);
  if (name == declaration.npos)
    throw Error(fmt::format("'{}' is not a type and a name, such as \"float radius\"", declaration), p.at);
  p.type = declaration.substr(begin, type_end - begin);
  p.name = declaration.substr(name, declaration.find_last_not_of(space) + 1 - name);
}

void read_value(Lexer& lexer, Parameter& p, Holds holds) {
  const Token token = lexer.next();
  const auto wrong = [&](const char* wanted) {
    throw Error(token.end() ? fmt::format("the file ends where \"{} {}\" needs {}", p.type, p.name, wanted)
                            : fmt::format("\"{} {}\" needs {}, not '{}'", p.type, p.name, wanted, token.text.substr(0, 60)),
                lexer.place(token));
  };
  const bool any = lexer.lenient != nullptr;  // fits_version_3 checks the complete list
  if (token.is(Token::Kind::string) && (any || holds != Holds::numbers)) {
    const std::string text = Lexer::unescaped(token.text);
    if (!any && holds == Holds::truths && text != "true" && text != "false") wrong("true or false");
    p.strings.push_back(text);
  } else if (token.is(Token::Kind::word) && holds == Holds::truths && (token.text == "true" || token.text == "false")) {
    p.strings.emplace_back(token.text);
  } else {
    double number = 0;
    const bool may = any || holds == Holds::numbers || holds == Holds::either;
    if (!may || !lexer.number(token, number))
      wrong(holds == Holds::truths ? "true or false" : holds == Holds::strings ? "a text in quotes" : "a finite number");
    p.numbers.push_back(number);
  }
}

/// The number of values that form one item of a type.
size_t width_of(std::string_view type) {
  if (type == "point2" || type == "vector2" || type == "spectrum") return 2;
  for (const char* three : {"point", "point3", "vector", "vector3", "normal", "normal3", "rgb", "color", "xyz"})
    if (type == three) return 3;
  return 1;
}

/// Version 3 ignores a parameter with values of another type, and surplus values of a list. False: the parameter is ignored.
bool fits_version_3(Parameter& p, Holds holds, Importing& importing) {
  const auto leave_out = [&](const char* why) {
    importing.inexact(fmt::format("\"{} {}\" {}: it is left out, as by version 3 of pbrt", p.type, p.name, why), p.at);
    return false;
  };
  if (!p.numbers.empty() && !p.strings.empty())
    throw Error(fmt::format("\"{} {}\" has texts and numbers in one list", p.type, p.name), p.at);
  if (p.numbers.empty() && p.strings.empty()) return leave_out("holds nothing");
  if (holds == Holds::numbers && !p.strings.empty()) return leave_out("needs numbers, not texts");
  if ((holds == Holds::strings || holds == Holds::truths) && !p.numbers.empty()) return leave_out("needs texts, not numbers");
  if (holds == Holds::truths)
    for (std::string& text : p.strings)
      if (text != "true" && text != "false") {
        importing.inexact(fmt::format("'{}' is neither true nor false: it is false, as in version 3 of pbrt", text), p.at);
        text = "false";
      }
  const size_t width = width_of(p.type), more = p.numbers.size() % width;
  if (more == 0 || !p.strings.empty()) return true;
  if (more == p.numbers.size()) return leave_out("has too few numbers");
  importing.inexact(fmt::format("\"{} {}\" takes numbers by {}: the last are left out", p.type, p.name, width), p.at);
  p.numbers.resize(p.numbers.size() - more);
  return true;
}

}  // namespace

Parameters Parameters::read(Lexer& lexer, std::string of, Location at) {
  Parameters all;
  all.of = std::move(of);
  all.at = at;
  all.lenient = lexer.lenient;
  while (lexer.peek().is(Token::Kind::string)) {
    const Token declaration = lexer.next();
    Parameter p;
    p.at = lexer.place(declaration);
    name_parameter(p, declaration.text);
    const Type* type = type_of(p, all.lenient);
    const Holds holds = type ? type->holds : Holds::either;
    if (lexer.peek().is(Token::Kind::open)) {
      const Token open = lexer.next();
      for (;;) {
        if (holds == Holds::numbers || holds == Holds::either) lexer.numbers(p.numbers);
        if (lexer.peek().is(Token::Kind::close)) break;
        if (lexer.peek().end()) throw Error("this list has no closing ']'", lexer.place(open));
        read_value(lexer, p, holds);
      }
      lexer.next();
    } else {
      read_value(lexer, p, holds);
    }
    if (!all.lenient || (type && fits_version_3(p, holds, *all.lenient))) all.add(std::move(p));
  }
  return all;
}

void Parameters::add(Parameter p) {
  constexpr size_t most = 1000;  // the largest directives have about 30
  if (own.size() + overridden.size() >= most) throw Error(fmt::format("{} has more than {} parameters", of, most), p.at);
  if (const auto earlier = std::ranges::find(own, p.name, &Parameter::name); earlier != own.end()) {
    overridden.emplace_back(p.name, earlier->at);
    *earlier = std::move(p);
  } else {
    own.push_back(std::move(p));
  }
}

const Parameter* Parameters::find(std::string_view name) const {
  if (!std::ranges::count(asked_, name)) asked_.emplace_back(name);
  for (const Parameter& p : own)
    if (p.name == name) {
      p.used = true;
      return &p;
    }
  if (defaults)
    for (const Parameter& p : *defaults)
      if (p.name == name) return &p;
  return nullptr;
}

const Parameter* Parameters::first_of(std::initializer_list<std::string_view> names) const {
  const Parameter* found = nullptr;
  for (const std::string_view name : names)
    if (!found) found = find(name);
  return found;
}

void Parameters::misfit(const Parameter& p, const std::string& what) const {
  const std::string text = fmt::format("'{}' of {} {}", p.name, of, what);
  if (!lenient) throw Error(text, p.at);
  lenient->inexact(text + ": it is as if it were not given, as in version 3 of pbrt", p.at);
}

const Parameter* Parameters::single(std::string_view name, bool text) const {
  const Parameter* p = find(name);
  if (!p) return nullptr;
  const size_t count = p->numbers.size() + p->strings.size();
  if (p->is("texture") && !text)
    misfit(*p, "must be a number here, not a texture");
  else if ((text ? p->strings.size() : p->numbers.size()) != 1 || count != 1)
    misfit(*p, fmt::format("must be one {}{}", text ? "text" : "number", count != 1 ? fmt::format(", not {}", count) : ""));
  else
    return p;
  return nullptr;
}

std::optional<double> Parameters::number(std::string_view name) const {
  const Parameter* p = single(name, false);
  return p ? std::optional(p->numbers[0]) : std::nullopt;
}

double Parameters::number(std::string_view name, double otherwise) const { return number(name).value_or(otherwise); }

double Parameters::first_number(std::string_view name, double otherwise) const {
  const Parameter* p = find(name);
  if (!lenient || !p || p->numbers.size() < 2) return number(name, otherwise);
  lenient->inexact(fmt::format("'{}' of {} must be one number, not {}: the first counts, as in version 3 of pbrt", p->name, of,
                               p->numbers.size()),
                   p->at);
  return p->numbers[0];
}

int Parameters::integer(std::string_view name, int otherwise) const {
  const Parameter* p = single(name, false);
  if (!p) return otherwise;
  double value = p->numbers[0];
  if (lenient && value != std::trunc(value)) {
    lenient->inexact(fmt::format("'{}' of {} must be a whole number, not {}: what is behind the point is left out, as by "
                                 "version 3 of pbrt",
                                 p->name, of, value),
                     p->at);
    value = std::trunc(value);
  }
  if (value != std::floor(value) || std::abs(value) > 2147483647)
    throw Error(fmt::format("'{}' of {} must be a whole number, not {}", p->name, of, value), p->at);
  return int(value);
}

bool Parameters::boolean(std::string_view name, bool otherwise) const {
  const Parameter* p = single(name, true);
  if (!p) return otherwise;
  if (p->is("bool")) return p->strings[0] == "true";
  misfit(*p, fmt::format("must be a bool, not a {}", p->type));
  return otherwise;
}

std::string Parameters::text(std::string_view name, const std::string& otherwise) const {
  const Parameter* p = single(name, true);
  return p ? p->strings[0] : otherwise;
}

DoublePoint3 Parameters::point(std::string_view name, const DoublePoint3& otherwise) const {
  const std::vector<double>& n = numbers(name, 3);
  if (n.size() > 3) misfit(*find(name), fmt::format("must be one point, not {}", n.size() / 3));
  return n.size() != 3 ? otherwise : DoublePoint3{n[0], n[1], n[2]};
}

const std::vector<double>& Parameters::numbers(std::string_view name, size_t width) const {
  static const std::vector<double> none;
  const Parameter* p = find(name);
  if (!p) return none;
  if (!p->strings.empty())
    misfit(*p, fmt::format("must be numbers, not a {}", p->type));
  else if (p->numbers.size() % width != 0)
    misfit(*p, fmt::format("has {} numbers, which are no multiple of {}", p->numbers.size(), width));
  else
    return p->numbers;
  return none;
}

std::vector<double> Parameters::take_numbers(std::string_view name, size_t width) {
  const std::vector<double>& found = numbers(name, width);
  for (Parameter& p : own)
    if (&p.numbers == &found) return std::move(p.numbers);
  return found;
}

std::vector<std::string> Parameters::texts(std::string_view name) const {
  const Parameter* p = find(name);
  if (!p) return {};
  if (!p->numbers.empty()) misfit(*p, "must be texts, not numbers");
  return p->strings;
}

bool Parameters::asked_for(std::string_view name) const { return std::ranges::count(asked_, name) > 0; }

Location Parameters::place(std::string_view name) const {
  const Parameter* p = find(name);
  return p && p->at.known() ? p->at : at;
}

void Parameters::tell_unused(Importing& importing) const {
  for (const auto& [name, place] : overridden)
    importing.inexact(fmt::format("the parameter '{}' of {} is given again: the last one counts, as in pbrt", name, of), place);
  for (const Parameter& p : own)
    if (!p.used)
      importing.inexact(fmt::format("the parameter '{}' of {} is not used{}", p.name, of, suggestion(p.name, asked_)), p.at);
}

void Parameters::ignore(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) find(name);
}

void Parameters::forget() const {
  for (const Parameter& p : own) p.used = true;
}

}  // namespace etendue::pbrt
