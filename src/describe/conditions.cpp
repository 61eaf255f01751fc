// Conditions under which a member has an effect, as predicates on other members of the same component.

#include <fmt/format.h>

#include <algorithm>

#include "etendue/describe/registry.h"

namespace etendue {

namespace {

/// Whether a value is set: not false, 0, empty, none, nor a map or colour that is 0 everywhere.
bool something(const Value& v) {
  if (v.none()) return false;
  if (const bool* b = v.as<bool>()) return *b;
  if (const auto* n = v.as<Number>()) return n->value != 0;
  if (const auto* s = v.as<std::string>()) return !s->empty();
  if (const auto* f = v.as<FilePath>()) return !f->empty();
  if (const auto* n = v.as<Numbers>()) return !n->values.empty();
  if (const auto* l = v.as<Value::List>()) return !l->empty();
  if (const auto* c = v.as<Color>()) return *c && (*c)->expression() != "0";
  if (const auto* part = v.as<Ref<Component>>()) {
    if (!*part) return false;
    const ClassInfo& info = (*part)->class_info();
    const Member* literal = info.literal.empty() ? nullptr : info.find(info.literal);
    return !literal || something(literal->get(**part, *literal));
  }
  return true;
}

bool is(const Value& v, const Member& member, const Condition::Wanted& wanted) {
  if (const bool* b = v.as<bool>()) return std::holds_alternative<bool>(wanted) && *b == std::get<bool>(wanted);
  if (const auto* s = v.as<std::string>())
    return std::holds_alternative<std::string>(wanted) && *s == std::get<std::string>(wanted);
  if (const auto* n = v.as<Number>()) {
    const Unit* unit = n->dimension == Dimension::none ? nullptr : find_unit(member.unit);
    // Compared as floats, since most members are floats.
    return std::holds_alternative<double>(wanted) &&
           float(unit ? n->value / unit->factor : n->value) == float(std::get<double>(wanted));
  }
  return false;
}

std::string text_of(const Condition::Wanted& wanted) {
  if (const bool* b = std::get_if<bool>(&wanted)) return *b ? "true" : "false";
  if (const double* x = std::get_if<double>(&wanted)) return fmt::format("{:.9g}", *x);
  const std::string& text = std::get<std::string>(wanted);
  return text.empty() ? "\"\"" : text;
}

}  // namespace

bool Condition::holds(const Component& c) const {
  const Member* of = c.class_info().find(member);
  if (!of) return true;
  const Value v = of->get(c, *of);
  const bool found =
      values.empty() ? something(v) : std::ranges::any_of(values, [&](const Wanted& w) { return is(v, *of, w); });
  return found != unless;
}

std::string Condition::text(const ClassInfo& info) const {
  const std::string quoted = "'" + member + "'";
  if (!values.empty()) {
    std::vector<std::string> names;
    for (const Wanted& w : values) names.push_back(text_of(w));
    return fmt::format("{} is {}{}", quoted, unless ? "not " : "", fmt::join(names, unless ? " nor " : " or "));
  }
  const Member* of = info.find(member);
  if (of && !of->list && of->kind == Kind::boolean) return quoted + (unless ? " is false" : " is true");
  const bool number = of && !of->list && (of->kind == Kind::number || of->kind == Kind::integer);
  const bool map_of_something = of && of->kind == Kind::component && !of->list && something(of->default_value);
  if (number || map_of_something || (of && of->meaning == Meaning::number)) return quoted + (unless ? " is 0" : " is not 0");
  return quoted + (unless ? " is not given" : " is given");
}

bool matters(const Component& c, const Member& m) {
  return std::ranges::all_of(m.conditions, [&](const Condition& condition) { return condition.holds(c); });
}

}  // namespace etendue
