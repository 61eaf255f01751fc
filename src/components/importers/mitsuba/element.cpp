#include "element.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue::mitsuba {

std::string kind_of(const Property& p) {
  static constexpr const char* names[] = {"a boolean", "an integer",  "a number", "a string",
                                          "a vector",  "a transform", "a colour", "a nested plugin"};
  return names[p.value.index()];
}

namespace {

[[noreturn]] void wrong(const Element& e, const Property& p, const char* expected) {
  throw Error(fmt::format("'{}' of {} '{}' must be {}, not {}", p.name, e.tag, e.type, expected, kind_of(p)), p.at);
}

}  // namespace

const Property* Element::find(const std::string& name) const {
  if (std::ranges::find(known, name) == known.end()) known.push_back(name);
  for (const Property& p : properties)
    if (p.name == name) {
      p.asked = true;
      return &p;
    }
  return nullptr;
}

double Element::number(const std::string& name, double otherwise) const {
  const Property* p = find(name);
  if (!p) return otherwise;
  if (const auto* x = std::get_if<double>(&p->value)) return *x;
  if (const auto* i = std::get_if<std::int64_t>(&p->value)) return double(*i);
  if (const auto* c = std::get_if<ColorValue>(&p->value); c && c->kind == ColorValue::Kind::flat) return c->rgb[0];
  wrong(*this, *p, "a number");
}

std::int64_t Element::integer(const std::string& name, std::int64_t otherwise) const {
  const Property* p = find(name);
  if (!p) return otherwise;
  if (const auto* i = std::get_if<std::int64_t>(&p->value)) return *i;
  if (const auto* x = std::get_if<double>(&p->value); x && *x == std::floor(*x) && std::abs(*x) < 1e15) return std::int64_t(*x);
  wrong(*this, *p, "an integer");
}

bool Element::boolean(const std::string& name, bool otherwise) const {
  const Property* p = find(name);
  if (!p) return otherwise;
  if (const auto* b = std::get_if<bool>(&p->value)) return *b;
  wrong(*this, *p, "a boolean");
}

std::string Element::string(const std::string& name, const std::string& otherwise) const {
  const Property* p = find(name);
  if (!p) return otherwise;
  if (const auto* s = std::get_if<std::string>(&p->value)) return *s;
  wrong(*this, *p, "a string");
}

DoubleVector3 Element::vector(const std::string& name, const DoubleVector3& otherwise) const {
  const Property* p = find(name);
  if (!p) return otherwise;
  if (const auto* v = std::get_if<DoubleVector3>(&p->value)) return *v;
  wrong(*this, *p, "a vector or a point");
}

TransformValue Element::transform(const std::string& name) const {
  const Property* p = find(name);
  if (!p) return {};
  const auto* t = std::get_if<TransformValue>(&p->value);
  if (!t) wrong(*this, *p, "a transform");
  if (!t->transform.valid()) throw Error(fmt::format("'{}' cannot be inverted: it makes things flat", name), p->at);
  return *t;
}

const Element* Element::nested(const std::string& name) const {
  const Property* p = find(name);
  if (!p) return nullptr;
  const auto* n = std::get_if<Nested>(&p->value);
  return n ? n->element : nullptr;
}

std::vector<const Element*> Element::all(const std::string& nested_tag) const {
  std::vector<const Element*> found;
  for (const Property& p : properties)
    if (const auto* n = std::get_if<Nested>(&p.value); n && n->element && n->element->tag == nested_tag) {
      p.asked = true;
      found.push_back(n->element);
    }
  return found;
}

Location Element::location_of(const std::string& name) const {
  const auto p = std::ranges::find(properties, name, &Property::name);
  return p == properties.end() ? at : p->at;
}

}  // namespace etendue::mitsuba
