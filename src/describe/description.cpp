#include "etendue/describe/description.h"

namespace etendue {

Component::Origin::Origin() = default;
Component::Origin::Origin(const Origin&) = default;
Component::Origin::~Origin() = default;
Component::Component() = default;

Condition::Condition() = default;
Condition::Condition(const Condition&) = default;
Condition::Condition(Condition&&) noexcept = default;
Condition& Condition::operator=(const Condition&) = default;
Condition& Condition::operator=(Condition&&) noexcept = default;
Condition::~Condition() = default;

Member::Member() = default;
Member::Member(const Member&) = default;
Member::Member(Member&&) noexcept = default;
Member& Member::operator=(const Member&) = default;
Member& Member::operator=(Member&&) noexcept = default;
Member::~Member() = default;

std::vector<std::string> detail::name_list(std::initializer_list<std::string_view> names) {
  return {names.begin(), names.end()};
}

Condition detail::condition(std::string_view member, std::initializer_list<Wanted> values, bool unless) {
  Condition c;
  c.member = member;
  c.unless = unless;
  for (const Wanted& v : values) switch (v.kind) {
      case Wanted::Kind::boolean: c.values.emplace_back(v.number != 0); break;
      case Wanted::Kind::number: c.values.emplace_back(v.number); break;
      case Wanted::Kind::text: c.values.emplace_back(std::string(v.text)); break;
    }
  return c;
}

void AnyDescription::set_summary(std::string_view text, std::string_view source) {
  info_.summary = text;
  info_.source = source;
}

void AnyDescription::finish() const {
  if (opened_ && opened_->members == info_.members.size()) throw Error("group '" + opened_->name + "' has no members");
}

void AnyDescription::open_group(std::string_view name) {
  finish();
  if (name.empty()) throw Error("a group has no name");
  for (const Member& m : info_.members)
    if (m.owner == &info_ && m.group == name) throw Error("group '" + std::string(name) + "' is opened twice");
  opened_ = {std::string(name), info_.members.size()};
}

Member& AnyDescription::add_member(std::string_view name, std::string_view unit, std::string_view text, const MemberType& type,
                                   std::string component_class) {
  Member& m = info_.members.emplace_back();
  m.name = name;
  m.unit = unit;
  m.text = text;
  m.kind = type.kind;
  m.list = type.list;
  m.in_double = type.in_double;
  m.component_class = std::move(component_class);
  m.owner = &info_;
  if (opened_) m.group = opened_->name;
  m.get = type.get;
  m.store = type.store;
  m.view = type.view;
  m.exchange = type.exchange;
  return m;
}

void AnyDescription::option(Member& m, std::vector<std::string> names) { m.choices = std::move(names); }
void AnyDescription::option(Member& m, Condition c) { m.conditions.push_back(std::move(c)); }

void AnyDescription::remove_member(std::string_view name, std::string_view why) {
  if (std::erase_if(info_.members, [&](const Member& m) { return m.name == name; }) == 0)
    throw Error("there is no member '" + std::string(name) + "' to remove");
  info_.absent.push_back({std::string(name), std::string(why)});
}

void AnyDescription::set_literal(std::string_view member) { info_.literal = member; }

}  // namespace etendue
