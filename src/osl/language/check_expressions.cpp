// Expressions: names, parts, conversions, lists, assignments.

#include <fmt/format.h>

#include <array>

#include "checker.h"
#include "conversions.h"
#include "folding.h"
#include "parser.h"

namespace etendue::osl {

namespace {

constexpr std::array<std::pair<const char*, Base>, global_count> global_types = {{{"P", Base::point},
                                                                                  {"I", Base::vector},
                                                                                  {"N", Base::normal},
                                                                                  {"Ng", Base::normal},
                                                                                  {"dPdu", Base::vector},
                                                                                  {"dPdv", Base::vector},
                                                                                  {"Ps", Base::point},
                                                                                  {"u", Base::float_},
                                                                                  {"v", Base::float_},
                                                                                  {"time", Base::float_},
                                                                                  {"dtime", Base::float_},
                                                                                  {"dPdtime", Base::vector},
                                                                                  {"Ci", Base::color}}};

}  // namespace

ExpressionPointer Checker::make(Expression::Kind kind, const Type& type, Location at) {
  count_node(at);
  auto e = std::make_unique<Expression>();
  e->kind = kind, e->type = type, e->place = at;
  return e;
}

ExpressionPointer Checker::value(const syntax::Expression& e, Type expected) {
  using Kind = syntax::Expression::Kind;
  const Deeper deeper(*this, e.place);
  switch (e.kind) {
    case Kind::integer: return make_constant(e.place, int(e.number));
    case Kind::real: return make_constant(e.place, float(e.number));
    case Kind::text: return make_constant(e.place, intern_string(e.name));
    case Kind::name: return name(e);
    case Kind::subscript: return subscript(e);
    case Kind::member: return member(e);
    case Kind::unary: return unary(e, expected);
    case Kind::binary: return binary(e, expected);
    case Kind::conditional: return conditional(e, expected);
    case Kind::assignment: return assignment(e);
    case Kind::increment: return increment(e);
    case Kind::call: return call(e, expected);
    case Kind::cast: return cast(e);
    case Kind::list:
      if (!expected.is_void()) return fold(list(e, expected));
      refuse(e.place, "the type of this list is not known here");
    case Kind::comma: {
      ExpressionPointer out = make(Expression::Kind::comma, {}, e.place);
      for (const syntax::ExpressionPointer& o : e.operands)
        out->operands.push_back(value(*o, o == e.operands.back() ? expected : Type()));
      out->type = out->operands.back()->type;
      return out;
    }
  }
  refuse(e.place, "this is no value");
}

ExpressionPointer Checker::value_as(const syntax::Expression& e, const Type& type, const char* what) {
  if (e.kind == syntax::Expression::Kind::list) return fold(list(e, type));
  return converted(value(e, type), type, what);
}

ExpressionPointer Checker::name(const syntax::Expression& e) {
  if (const Scope::Entry* entry = scope_->find(e.name)) {
    if (!entry->symbol)
      refuse(e.place, fmt::format("'{}' is a {}, not a variable", e.name, entry->function ? "function" : "structure"));
    ExpressionPointer out = make(Expression::Kind::variable, entry->symbol->type, e.place);
    out->symbol = entry->symbol;
    entry->symbol->read = true;
    return out;
  }
  for (std::size_t i = 0; i < global_types.size(); ++i) {
    if (e.name != global_types[i].first) continue;
    Symbol*& known = shader_->globals[i];
    if (!known) {
      const Type type = Global(i) == Global::Ci ? Type::closure_color() : Type(global_types[i].second);
      known = make_symbol(e.name, type, Symbol::Role::global, e.place);
      known->global = Global(i);
    }
    known->read = true;
    ExpressionPointer out = make(Expression::Kind::variable, known->type, e.place);
    out->symbol = known;
    return out;
  }
  std::vector<std::string> names;
  for (const Scope* s = scope_; s; s = s->parent)
    for (const auto& [known, entries] : s->names)
      if (entries.back().symbol) names.push_back(known);
  for (const auto& [known, base] : global_types) names.emplace_back(known);
  refuse(e.place, fmt::format("'{}' was not declared{}", e.name, suggestion(e.name, names)));
}

ExpressionPointer Checker::subscript(const syntax::Expression& e) {
  // m[i][j] of a matrix is one node.
  const syntax::Expression& inner = *e.operands[0];
  const auto index = [&](const syntax::Expression& i) {
    ExpressionPointer v = value(i, Base::int_);
    if (!v->type.is_int()) refuse(i.place, fmt::format("an index must be an int, not '{}'", v->type.name()));
    return v;
  };
  if (inner.kind == syntax::Expression::Kind::subscript) {
    ExpressionPointer whole = value(*inner.operands[0]);
    if (whole->type.is_matrix()) {
      ExpressionPointer row = index(*inner.operands[1]);
      return make(Expression::Kind::matrix_component, Base::float_, e.place, std::move(whole), std::move(row),
                  index(*e.operands[1]));
    }
    if (whole->type.is_array()) {
      ExpressionPointer element =
          make(Expression::Kind::element, whole->type.element(), inner.place, std::move(whole), index(*inner.operands[1]));
      if (element->type.is_triple())
        return fold(make(Expression::Kind::component, Base::float_, e.place, fold(std::move(element)), index(*e.operands[1])));
      if (element->type.is_matrix()) refuse(e.place, "a matrix has two indices, M[row][column]");
    }
    refuse(e.place, fmt::format("'{}' cannot be indexed twice", whole ? whole->type.name() : std::string("this")));
  }
  // m[i][j] of an element of an array of matrices, a[k][i][j]: the two inner subscripts were one node above.
  ExpressionPointer whole = value(inner);
  if (whole->type.is_array())
    return fold(make(Expression::Kind::element, whole->type.element(), e.place, std::move(whole), index(*e.operands[1])));
  if (whole->type.is_triple())
    return fold(make(Expression::Kind::component, Base::float_, e.place, std::move(whole), index(*e.operands[1])));
  if (whole->type.is_matrix()) refuse(e.place, "a matrix has two indices, M[row][column]");
  refuse(e.place, fmt::format("'{}' cannot be indexed", whole->type.name()));
}

ExpressionPointer Checker::member(const syntax::Expression& e) {
  ExpressionPointer whole = value(*e.operands[0]);
  const Type type = whole->type;
  if (type.is_structure() && !type.is_array()) {
    const Field* field = type.structure->find(e.name);
    if (!field) {
      std::vector<std::string> names;
      for (const Field& f : type.structure->fields) names.push_back(f.name);
      refuse(e.place, fmt::format("the structure '{}' has no field '{}'{}", type.name(), e.name, suggestion(e.name, names)));
    }
    ExpressionPointer out = make(Expression::Kind::field, field->type, e.place, std::move(whole));
    out->index = int(field - type.structure->fields.data());
    return fold(std::move(out));
  }
  if (type.is_triple()) {
    const std::string names = type.base == Base::color ? "rgb" : "xyz";
    const std::size_t found = e.name.size() == 1 ? names.find(e.name[0]) : std::string::npos;
    const std::size_t other = e.name.size() == 1 ? std::string("rgbxyz").find(e.name[0]) : std::string::npos;
    if (found != std::string::npos || other != std::string::npos)
      return fold(make(Expression::Kind::component, Base::float_, e.place, std::move(whole),
                       make_constant(e.place, int((found != std::string::npos ? found : other) % 3))));
    refuse(e.place, fmt::format("'{}' has no component '{}'", type.name(), e.name));
  }
  refuse(e.place, fmt::format("'{}' has no fields", type.name()));
}

// ---- conversions

/// The conversion itself; its existence was checked.
ExpressionPointer Checker::convert(ExpressionPointer e, const Type& to) {
  if (e->type == to) return e;
  const Location at = e->place;
  return fold(make(Expression::Kind::conversion, to, at, std::move(e)));
}

ExpressionPointer Checker::converted(ExpressionPointer e, const Type& to, const char* what) {
  const Type from = e->type;
  if (from == to) return e;
  if (to.is_closure() && !to.is_array() && e->kind == Expression::Kind::constant && !from.is_closure()) {
    // The number 0 is the closure that does nothing.
    const bool zero = (from.is_int() && e->constant.at<int>() == 0) || (from.is_float() && e->constant.at<float>() == 0);
    const void* null = nullptr;
    if (zero) return make_constant(e->place, to, &null);
  }
  if (!assignable(to, from))
    refuse(e->place, fmt::format("{}: '{}' cannot take a value of type '{}'", what, to.name(), from.name()));
  if (to.is_array()) return e;  // of another length, or of another kind of triples
  return convert(std::move(e), to);
}

ExpressionPointer Checker::cast(const syntax::Expression& e) {
  const Type to = type_of(e.type);
  if (to.is_void()) refuse(e.place, "a value cannot be converted to void");
  if (e.operands[0]->kind == syntax::Expression::Kind::list) return fold(list(*e.operands[0], to));
  ExpressionPointer v = value(*e.operands[0], to);
  if (v->type == to) return v;
  if (to.is_closure()) return converted(std::move(v), to, "the conversion");
  if (!castable(to, v->type) || to.is_array())
    refuse(e.place, fmt::format("a value of type '{}' cannot be converted to '{}'", v->type.name(), to.name()));
  return convert(std::move(v), to);
}

// ---- lists

bool Checker::fits_list(const syntax::Expression& e, const Type& t) {
  if (t.is_array())
    return (t.array == Type::unsized || int(e.operands.size()) <= t.array) &&
           std::all_of(e.operands.begin(), e.operands.end(),
                       [&](const auto& o) { return o->kind != syntax::Expression::Kind::list || fits_list(*o, t.element()); });
  if (t.is_structure()) {
    const auto& fields = t.structure->fields;
    if (e.operands.size() > fields.size()) return false;
    for (std::size_t i = 0; i < e.operands.size(); ++i)
      if (e.operands[i]->kind == syntax::Expression::Kind::list && !fits_list(*e.operands[i], fields[i].type)) return false;
    return true;
  }
  if (t.is_closure() || t.is_void()) return false;
  if (t.is_triple()) return e.operands.size() == 1 || e.operands.size() == 3 || e.operands.size() == 4;
  if (t.is_matrix()) return e.operands.size() == 1 || e.operands.size() == 2 || e.operands.size() >= 16;
  return e.operands.size() == 1;
}

ExpressionPointer Checker::list(const syntax::Expression& e, const Type& given) {
  Type t = given;
  if (t.array == Type::unsized) t.array = std::max(1, int(e.operands.size()));
  if (t.is_array() || t.is_structure()) {
    const std::size_t most = t.is_array() ? std::size_t(t.array) : t.structure->fields.size();
    if (e.operands.size() > most)
      refuse(e.place, fmt::format("{} values for '{}', which has {}", e.operands.size(), t.name(), most));
    ExpressionPointer out = make(Expression::Kind::aggregate, t, e.place);
    for (std::size_t i = 0; i < e.operands.size(); ++i) {
      const Type part = t.is_array() ? t.element() : t.structure->fields[i].type;
      out->operands.push_back(value_as(*e.operands[i], part, t.is_array() ? "an element" : "a field"));
    }
    return fold(std::move(out));
  }
  if (t.is_closure()) refuse(e.place, "a closure cannot be made of a list");
  if (e.operands.size() == 1 && e.operands[0]->kind != syntax::Expression::Kind::list)
    return converted(value(*e.operands[0], t), t, "the list");
  // A triple or matrix: its constructor.
  std::vector<Argument> arguments;
  for (const syntax::ExpressionPointer& o : e.operands) arguments.push_back({value(*o, Base::float_), nullptr, o->place});
  return call(t.name(), std::move(arguments), t, e.place);
}

// ---- assignments

void Checker::must_be_writable(const Expression& e) {
  const Symbol* root = e.root();
  if (!root) refuse(e.place, "only a variable, or a part of one, can be written");
  switch (root->role) {
    case Symbol::Role::argument:
      // The reference implementation lets it pass, too.
      if (!root->written)
        diagnostics_.warning(e.place,
                             fmt::format("'{}' is written, but is a parameter without 'output': the function changes a "
                                         "copy of its own",
                                         root->name));
      break;
    case Symbol::Role::parameter:
      refuse(e.place, fmt::format("'{}' cannot be written: it is a parameter without 'output'", root->name));
    default: break;
  }
  const_cast<Symbol*>(root)->written = true;
}

ExpressionPointer Checker::assignment(const syntax::Expression& e) {
  ExpressionPointer to = value(*e.operands[0]);
  must_be_writable(*to);
  const Type type = to->type;
  const syntax::Expression& right = *e.operands[1];
  if (right.kind == syntax::Expression::Kind::list) {
    if (e.operation != Operator::none) refuse(e.place, "a list can only be assigned by '='");
    return make(Expression::Kind::assignment, type, e.place, std::move(to), fold(list(right, type)));
  }
  ExpressionPointer v = value(right, type);
  if (e.operation == Operator::none) {
    const Symbol* root = to->root();
    // Elements of int arrays take floats, as in the reference implementation (variables do not).
    if (to->kind == Expression::Kind::element && type.is_int() && v->type.is_float()) v = convert(std::move(v), type);
    return make(Expression::Kind::assignment, type, e.place, std::move(to), converted(std::move(v), type, root->name.c_str()));
  }
  // The types are those of `to operation value`; the result must be of the variable's type.
  ExpressionPointer left = value(*e.operands[0]);
  ExpressionPointer both = operation(e.operation, std::move(left), std::move(v), e.place);
  if (!equivalent(both->type, type)) {
    if (!assignable(type, both->type))
      refuse(e.place, fmt::format("'{}' cannot take the result, which has the type '{}'", type.name(), both->type.name()));
    return make(Expression::Kind::assignment, type, e.place, std::move(to), convert(std::move(both), type));
  }
  const bool direct = both->kind == Expression::Kind::binary && both->operation == e.operation &&
                      both->operands[0]->type == type && both->operands[0]->is_reference();
  if (!direct) return make(Expression::Kind::assignment, type, e.place, std::move(to), convert(std::move(both), type));
  ExpressionPointer out = make(Expression::Kind::assignment, type, e.place, std::move(to), std::move(both->operands[1]));
  dropped_.push_back(std::move(both->operands[0]));
  out->operation = e.operation;
  return out;
}

ExpressionPointer Checker::increment(const syntax::Expression& e) {
  ExpressionPointer to = value(*e.operands[0]);
  must_be_writable(*to);
  const Type type = to->type;
  if (!type.is_int() && !type.is_float()) refuse(e.place, fmt::format("'{}' cannot be counted up or down", type.name()));
  ExpressionPointer out = make(Expression::Kind::increment, type, e.place, std::move(to));
  out->index = e.direction, out->postfix = e.postfix;
  return out;
}

}  // namespace etendue::osl
