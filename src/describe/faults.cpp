#include "faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace etendue {

namespace {

bool is_numeric(const Member& m) {
  return m.kind == Kind::integer || m.kind == Kind::number || m.kind == Kind::vector2 || m.kind == Kind::vector3 ||
         m.kind == Kind::point3;
}

/// Whether a colour or map may have a slider: only if it states how its number is read.
bool may_be_number(const Member& m) {
  return m.kind == Kind::color || (m.kind == Kind::component && m.meaning != Meaning::plain);
}

std::string slider_fault(const Member& m) {
  if (m.soft) {
    if (!is_numeric(m) && !may_be_number(m)) return "has a slider, but is not a number";
    if (!(m.soft->low < m.soft->high) || !std::isfinite(m.soft->low) || !std::isfinite(m.soft->high))
      return fmt::format("has a slider from {} to {}", m.soft->low, m.soft->high);
    for (const double end : {m.soft->low, m.soft->high})
      if (m.range && !m.range->contains(end))
        return fmt::format("has a slider that ends at {}, but must be {}", end, m.range->text());
  }
  if (!m.logarithmic) return {};
  const double low = m.soft    ? m.soft->low
                     : m.range ? m.range->low
                               : 0,
               high = m.soft    ? m.soft->high
                      : m.range ? m.range->high
                                : 0;
  if (is_numeric(m) && (!m.range || m.range->low < 0)) return "is logarithmic, but may be negative";
  if (!(low > 0) || !std::isfinite(high)) return "is logarithmic, but its slider's ends are not positive and finite";
  return {};
}

std::string choices_fault(const Member& m) {
  if (m.kind == Kind::choice && m.choices.empty()) return "does not name its choices";
  if (m.choices.empty()) return {};
  if (m.kind != Kind::choice && m.kind != Kind::string) return "has choices, but is not a string";
  if (std::set<std::string>(m.choices.begin(), m.choices.end()).size() != m.choices.size()) return "has a choice twice";
  return {};
}

std::string meaning_fault(const Member& m) {
  if (m.meaning == Meaning::plain) return {};
  if (m.kind == Kind::color && m.meaning != Meaning::number) return {};
  if (m.kind == Kind::component) return {};
  return fmt::format("is read as {}, but is not a {}", name(m.meaning), m.meaning == Meaning::number ? "map" : "colour or map");
}

/// The fault of a value that a condition compares with.
std::string wanted_fault(const Member& of, const Condition::Wanted& wanted) {
  if (of.list) return fmt::format("'{}' is a list", of.name);
  if (std::holds_alternative<bool>(wanted))
    return of.kind == Kind::boolean ? "" : fmt::format("'{}' is not true or false", of.name);
  if (const auto* x = std::get_if<double>(&wanted)) {
    if (of.kind != Kind::number && of.kind != Kind::integer) return fmt::format("'{}' is not a number", of.name);
    return !of.range || of.range->contains(*x) ? "" : fmt::format("'{}' is never {}", of.name, *x);
  }
  const std::string& text = std::get<std::string>(wanted);
  if (of.kind != Kind::choice && of.kind != Kind::string) return fmt::format("'{}' is not a string", of.name);
  const bool known = of.choices.empty() || std::ranges::find(of.choices, text) != of.choices.end();
  return known ? "" : fmt::format("'{}' has no choice '{}'", of.name, text);
}

/// Whether a member can be both set and not set (see `something` in conditions.cpp).
bool may_be_nothing(const Member& m) {
  if (m.list) return !m.required;
  switch (m.kind) {
    case Kind::boolean:
    case Kind::color:
    case Kind::component: return !m.required;
    case Kind::file: return !m.required;
    case Kind::string: return m.choices.empty() || std::ranges::find(m.choices, "") != m.choices.end();
    case Kind::number:
    case Kind::integer: return !m.range || m.range->contains(0);
    default: return false;
  }
}

std::string condition_fault(const ClassInfo& info, const Member& m, const Condition& c) {
  const Member* of = info.find(c.member);
  if (!of) return fmt::format("there is no member '{}'", c.member);
  if (of->name == m.name) return "it is the member itself";
  if (c.values.empty() && !may_be_nothing(*of)) return fmt::format("'{}' can never be empty", c.member);
  for (const Condition::Wanted& wanted : c.values)
    if (const std::string wrong = wanted_fault(*of, wanted); !wrong.empty()) return wrong;
  const size_t all = of->kind == Kind::boolean ? 2 : of->choices.size();
  if (all > 0 && c.values.size() >= all) return fmt::format("it names all values of '{}'", c.member);
  return {};
}

std::string member_fault(const ClassInfo& info, const Member& m) {
  if (m.text.empty()) return "is not documented";
  if (is_numeric(m) && m.kind != Kind::integer && m.unit.empty()) return "has no unit";
  for (const auto check : {slider_fault, choices_fault, meaning_fault})
    if (const std::string wrong = check(m); !wrong.empty()) return wrong;
  if (m.required && !m.conditions.empty()) return "is required, but has no effect under its condition";
  for (const Condition& c : m.conditions)
    if (const std::string wrong = condition_fault(info, m, c); !wrong.empty())
      return fmt::format("has an impossible condition on '{}': {}", c.member, wrong);
  return {};
}

}  // namespace

std::string fault(const ClassInfo& info) {
  if (info.summary.empty()) return "has no summary";
  for (size_t i = 0; i < info.members.size(); ++i) {
    const Member& m = info.members[i];
    if (const std::string wrong = member_fault(info, m); !wrong.empty()) return "member '" + m.name + "' " + wrong;
    for (size_t k = 0; k < i; ++k)
      if (info.members[k].name == m.name) return "member '" + m.name + "' is described twice";
  }
  if (!info.literal.empty() && !info.find(info.literal)) return "has no member '" + info.literal + "' to stand for it";
  return {};
}

}  // namespace etendue
