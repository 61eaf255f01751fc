#include "etendue/describe/value.h"

#include <array>
#include <map>

#include "etendue/describe/registry.h"
#include "files/sent_files.h"

namespace etendue {

Value::Value() = default;
Value::Value(const Value&) = default;
Value::Value(Value&&) noexcept = default;
Value& Value::operator=(const Value&) = default;
Value& Value::operator=(Value&&) noexcept = default;
Value::~Value() = default;
template Value::Value(bool, Location);
template Value::Value(Number, Location);
template Value::Value(std::string, Location);
template Value::Value(Numbers, Location);
template Value::Value(FilePath, Location);
template Value::Value(Color, Location);
template Value::Value(Transform, Location);
template Value::Value(AnimatedTransform, Location);
template Value::Value(Ref<Component>, Location);
template Value::Value(Value::List, Location);

const std::vector<Unit>& units() {
  static const std::vector<Unit> all = {
      {"m", Dimension::length, 1},         {"cm", Dimension::length, 1e-2},
      {"mm", Dimension::length, 1e-3},     {"km", Dimension::length, 1e3},
      {"um", Dimension::length, 1e-6},     {"nm", Dimension::length, 1e-9},
      {"rad", Dimension::angle, 1},        {"deg", Dimension::angle, 0.017453292519943295769},
      {"K", Dimension::temperature, 1},    {"W", Dimension::power, 1},
      {"mW", Dimension::power, 1e-3},      {"kW", Dimension::power, 1e3},
      {"lm", Dimension::luminous_flux, 1}, {"cd", Dimension::luminous_intensity, 1},
      {"lx", Dimension::illuminance, 1},   {"s", Dimension::time, 1},
      {"ms", Dimension::time, 1e-3},
  };
  return all;
}

const Unit* find_unit(std::string_view name) {
  for (const Unit& u : units())
    if (u.name == name) return &u;
  return nullptr;
}

std::string_view name(Dimension d) {
  constexpr std::array<std::string_view, 9> names = {
      "pure number", "length", "angle", "temperature", "power", "luminous flux", "luminous intensity", "illuminance", "time"};
  return names[size_t(d)];
}

std::string with_article(std::string_view word) {
  const bool vowel = !word.empty() && std::string_view("aeiouAEIOU").find(word.front()) != std::string_view::npos;
  return (vowel ? "an " : "a ") + std::string(word);
}

std::string FilePath::resolved() const {
  if (folder.empty() || text.empty() || text.front() == '/') return where_sent(text);
  return folder + "/" + text;
}

std::string Value::kind() const {
  struct Name {
    std::string operator()(std::monostate) const { return "none"; }
    std::string operator()(bool) const { return "true or false"; }
    std::string operator()(const Number& n) const {
      return n.dimension == Dimension::none ? "a number" : with_article(etendue::name(n.dimension));
    }
    std::string operator()(const std::string&) const { return "a string"; }
    std::string operator()(const Numbers& n) const {
      return n.width == 1 ? "a list of " + std::to_string(n.values.size()) + " numbers"
                          : "a list of " + std::to_string(n.rows()) + " rows of " + std::to_string(n.width) + " numbers";
    }
    std::string operator()(const FilePath&) const { return "a file"; }
    std::string operator()(const Color&) const { return "a colour"; }
    std::string operator()(const Transform&) const { return "a transform"; }
    std::string operator()(const AnimatedTransform&) const { return "a moving transform"; }
    std::string operator()(const Ref<Component>& c) const {
      return c ? "a component of class " + c->class_info().name : "none";
    }
    std::string operator()(const List&) const { return "a list"; }
  };
  return std::visit(Name(), data);
}

namespace {

using Seen = std::map<std::pair<const Component*, const Component*>, bool>;

bool same(const Value& a, const Value& b, Seen& seen);

bool same(const Component& a, const Component& b, Seen& seen) {
  if (&a == &b) return true;
  const auto [entry, fresh] = seen.try_emplace({&a, &b}, true);
  if (!fresh) return entry->second;
  const ClassInfo& info = a.class_info();
  bool equal_members = &info == &b.class_info();
  for (size_t i = 0; equal_members && i < info.members.size(); ++i) {
    const Member& m = info.members[i];
    equal_members = same(m.get(a, m), m.get(b, m), seen);
  }
  return seen[{&a, &b}] = equal_members;
}

bool is_null(const Value& v) {
  if (v.none()) return true;
  const auto* c = v.as<Ref<Component>>();
  return c && !*c;
}

bool is_empty_list(const Value& v) {
  const auto* n = v.as<Numbers>();
  const auto* l = v.as<Value::List>();
  return (n && n->values.empty()) || (l && l->empty());
}

bool same(const Value& a, const Value& b, Seen& seen) {
  if (is_null(a) || is_null(b)) return is_null(a) && is_null(b);
  if (is_empty_list(a) || is_empty_list(b)) return is_empty_list(a) && is_empty_list(b);
  if (a.data.index() != b.data.index()) return false;
  if (const auto* c = a.as<Ref<Component>>()) return same(**c, **b.as<Ref<Component>>(), seen);
  if (const auto* color = a.as<Color>()) return (*color)->expression() == (*b.as<Color>())->expression();
  if (const auto* list = a.as<Value::List>()) {
    const auto& other = *b.as<Value::List>();
    if (list->size() != other.size()) return false;
    for (size_t i = 0; i < list->size(); ++i)
      if (!same((*list)[i], other[i], seen)) return false;
    return true;
  }
  return a.data == b.data;
}

}  // namespace

bool equal(const Value& a, const Value& b) {
  Seen seen;
  return same(a, b, seen);
}

}  // namespace etendue
