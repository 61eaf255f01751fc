#include "signatures.h"

#include <array>
#include <unordered_map>

#include "parser.h"

namespace etendue::osl {

namespace {

using Table = std::unordered_map<std::string, std::vector<Signature>>;

constexpr std::array family_type = {Base::float_, Base::color, Base::vector, Base::point, Base::normal};
constexpr std::array family_triple = {Base::color, Base::vector, Base::point, Base::normal};
constexpr std::array family_ptype = {Base::vector, Base::point, Base::normal};

/// The bases of a family of types; one base for a simple type.
std::span<const Base> family(const std::string& name) {
  if (name == "TYPE") return family_type;
  if (name == "TRIPLE") return family_triple;
  if (name == "PTYPE") return family_ptype;
  return {};
}

Type type_of(const syntax::TypeName& t, Base of_family) {
  if (!family(t.name).empty()) return of_family;
  Type type = simple_type(t.name);
  type.closure = t.closure;
  return type;
}

Signature make(const syntax::FunctionDeclaration& f, Base of_family) {
  Signature s;
  s.name = f.name;
  s.result = type_of(f.result, of_family);
  for (const syntax::Declarator& p : f.parameters) {
    Signature::Parameter parameter;
    parameter.any = p.type.name == "ANY";
    parameter.output = p.output;
    parameter.type = type_of(p.type, of_family);
    if (p.array) parameter.type.array = p.length ? int(p.length->number) : Type::unsized;
    s.parameters.push_back(parameter);
  }
  s.variadic = f.variadic, s.output_variadic = f.output_variadic;
  return s;
}

void add_row(Table& table, const Row& row) {
  const auto f = parse_signature(row.signature);
  std::span<const Base> bases = family(f->result.name);
  for (const syntax::Declarator& p : f->parameters)
    if (bases.empty()) bases = family(p.type.name);
  static constexpr std::array one = {Base::void_};
  if (bases.empty()) bases = one;
  for (const Base base : bases) {
    Signature s = make(*f, base);
    s.row = &row;
    table[s.name].push_back(std::move(s));
  }
}

Table make_table() {
  Table table;
  for (const Row& row : library_rows()) add_row(table, row);
  int index = 0;
  for (const ClosureSignature& closure : closures()) {
    Signature s = make(*parse_signature(closure.signature), Base::void_);
    s.closure = index++;
    if (*closure.keywords) {
      const auto keywords = parse_signature(std::string("void keywords(") + closure.keywords + ")");
      for (const syntax::Declarator& k : keywords->parameters) s.keywords.emplace_back(k.name, type_of(k.type, Base::void_));
    }
    table[s.name].push_back(std::move(s));
  }
  return table;
}

}  // namespace

const std::vector<Signature>& library_signatures(const std::string& name) {
  static const Table table = make_table();
  static const std::vector<Signature> none;
  const auto found = table.find(name);
  return found == table.end() ? none : found->second;
}

Type simple_type(const std::string& name) {
  static const std::unordered_map<std::string, Base> types = {
      {"int", Base::int_},      {"float", Base::float_},  {"color", Base::color},
      {"point", Base::point},   {"vector", Base::vector}, {"normal", Base::normal},
      {"matrix", Base::matrix}, {"string", Base::string}, {"spectrum", Base::spectrum}};
  const auto found = types.find(name);
  return found == types.end() ? Type() : Type(found->second);
}

}  // namespace etendue::osl
