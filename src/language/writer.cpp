// Writer: components as text: which are shared and named, which members are written, and in which order.

#include "writer.h"

#include <fmt/format.h>

#include <filesystem>

#include "color/named.h"
#include "etendue/describe/description.h"
#include "etendue/language/language.h"
#include "lexer.h"

namespace etendue::language {

namespace {

constexpr int line_width = 100;
constexpr int step = 4;

/// Calls f for each component in a value.
template <class F>
void for_components(const Value& value, F&& f) {
  if (const auto* c = value.as<Ref<Component>>()) {
    if (*c) f(**c);
  } else if (const auto* list = value.as<Value::List>()) {
    for (const Value& item : *list) for_components(item, f);
  }
}

/// Converts "PhongShader" to "phong_shader".
std::string snake_case(const std::string& class_name) {
  std::string result;
  for (const char c : class_name) {
    const bool capital = c >= 'A' && c <= 'Z';
    if (capital && !result.empty()) result += '_';
    result += capital ? char(c - 'A' + 'a') : c;
  }
  return result;
}

bool usable_name(const std::string& name) {
  for (const char* reserved :
       {"true", "false", "none", "pi", "param", "include", "plugin", "if", "then", "else", "for", "not", "and", "or"})
    if (name == reserved) return false;
  return is_name(name);
}

}  // namespace

std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'), digit = c >= '0' && c <= '9';
    if (letter || (digit && !plain.empty()))
      plain += c;
    else if (!plain.empty() && plain.back() != '_')
      plain += '_';
  }
  while (!plain.empty() && plain.back() == '_') plain.pop_back();
  constexpr size_t longest = 64;
  return plain.substr(0, longest);
}

bool Writer::written(const Value& value, const Member& member) const {
  return all_ || member.required || !equal(value, member.default_value);
}

void Writer::collect(const Component& c) {
  const ClassInfo& info = c.class_info();
  if (!info.provider.empty()) plugins_.insert(info.provider);
  for (const Member& member : info.members) {
    if (member.kind != Kind::component) continue;
    const Value value = member.get(c, member);
    if (!written(value, member)) continue;
    for_components(value, [&](const Component& child) {
      if (parts_[&child].uses++ > 0) return;
      collect(child);
      order_.push_back(&child);
    });
  }
}

void Writer::choose_names() {
  std::set<std::string> taken;
  std::vector<const Component*> nameless;
  for (const Component* c : order_) {
    const std::string given = c->origin ? c->origin->name : std::string();
    if (usable_name(given) && taken.insert(given).second)
      parts_[c].name = given;
    else if (parts_[c].uses > 1 || !given.empty())
      nameless.push_back(c);
  }
  for (const Component* c : nameless) {
    const std::string given = c->origin ? c->origin->name : std::string();
    const std::string plain = plain_name(given);
    const std::string stem = usable_name(given) ? given : (usable_name(plain) ? plain : snake_case(c->class_info().name));
    std::string name = stem;
    for (int i = 2; !usable_name(name) || !taken.insert(name).second; ++i) name = fmt::format("{}_{}", stem, i);
    parts_[c].name = name;
  }
}

std::vector<std::pair<std::string, const Component*>> Writer::named_parts(const Component& root) {
  collect(root);
  choose_names();
  std::vector<std::pair<std::string, const Component*>> named;
  for (const Component* c : order_)
    if (c->origin && !c->origin->name.empty() && !parts_[c].name.empty()) named.emplace_back(parts_[c].name, c);
  return named;
}

std::string Writer::description(const Component& root) {
  collect(root);
  choose_names();
  std::string result;
  for (const std::string& plugin : plugins_) result += "plugin " + etendue::quoted(path_text({plugin, {}}, folder_)) + "\n";
  if (!plugins_.empty()) result += "\n";
  bool any = false;
  for (const Component* c : order_) {
    const std::string& name = parts_[c].name;
    if (name.empty()) continue;
    any = true;
    result += name + " = " + component(*c, 0, int(name.size()) + 3) + "\n";
  }
  if (any) result += "\n";
  return result + component(root, 0, 0) + "\n";
}

std::string Writer::component(const Component& c, int indent, int column) {
  const ClassInfo& info = c.class_info();
  std::vector<std::string> items;
  size_t width = size_t(column) + info.name.size() + 4;
  bool short_enough = true;
  for (const Member& member : info.members) {
    const Value v = member.get(c, member);
    if (!written(v, member)) continue;
    items.push_back(member.name + ": " + value(v, &member, indent + step, indent + step + int(member.name.size()) + 2));
    width += items.back().size() + 2;
    short_enough = short_enough && items.back().find('\n') == std::string::npos;
  }
  if (items.empty()) return info.name + " {}";
  if (short_enough && width <= line_width) return fmt::format("{} {{ {} }}", info.name, fmt::join(items, ", "));
  std::string result = info.name + " {\n";
  for (std::string& item : items) {
    result.append(size_t(indent) + step, ' ').append(item) += '\n';
    item = {};
  }
  return result.append(size_t(indent), ' ') + "}";
}

const Member* Writer::literal(const Component& c, const Member* member) const {
  const ClassInfo& info = c.class_info();
  if (info.literal.empty() || !member) return nullptr;
  for (const Member& other : info.members)
    if (other.name != info.literal && (all_ || !equal(other.get(c, other), other.default_value))) return nullptr;
  const Member& only = *info.find(info.literal);
  const Value v = only.get(c, only);
  if (v.none() || v.as<Ref<Component>>() || v.as<Value::List>()) return nullptr;
  try {
    const Ref<Component> read = detail::to_component(v, *member);
    if (!read || &read->class_info() != &info || !equal(read->class_info().find(info.literal)->get(*read, only), v))
      return nullptr;
  } catch (const Error&) {
    return nullptr;
  }
  return &only;
}

std::string Writer::part(const Component& c, const Member* member, int indent, int column) {
  const auto known = parts_.find(&c);
  if (known != parts_.end() && !known->second.name.empty()) return known->second.name;
  const Member* only = literal(c, member);
  return only ? value(only->get(c, *only), only, indent, column) : component(c, indent, column);
}

std::string Writer::value(const Value& v, const Member* member, int indent, int column) {
  if (const auto* flag = v.as<bool>()) return *flag ? "true" : "false";
  if (const auto* number = v.as<Number>()) {
    double factor = 1;
    const std::string suffix = unit_suffix(number->dimension, member, factor);
    return number_text(number->value, factor, member && member->kind == Kind::integer, member && member->in_double) + suffix;
  }
  if (const auto* text = v.as<std::string>()) {
    const bool word = member && member->kind == Kind::choice && usable_name(*text);
    return word ? *text : etendue::quoted(*text);
  }
  if (const auto* n = v.as<Numbers>()) return numbers(*n, member, indent, column);
  if (const auto* file = v.as<FilePath>()) return etendue::quoted(path_text(*file, folder_));
  if (const auto* color = v.as<Color>()) return *color ? color_text(**color, folder_) : "none";
  const auto matrix = [](const Transform& t) {
    std::vector<std::string> entries;
    for (const double x : t.exact()) entries.push_back(number_text(x, 1, false, true));
    return fmt::format("matrix({})", fmt::join(entries, ", "));
  };
  if (const auto* still = v.as<Transform>()) return matrix(*still);
  if (const auto* moving = v.as<AnimatedTransform>()) {
    std::vector<std::string> keys;
    for (const auto& key : moving->keys())
      keys.push_back(fmt::format("{} s, {}", number_text(double(key.time), 1, false), matrix(key.transform)));
    const std::string separator = ",\n" + std::string(size_t(indent) + step, ' ');
    return fmt::format("keyframes({})", fmt::join(keys, separator));
  }
  if (const auto* c = v.as<Ref<Component>>()) return *c ? part(**c, member, indent, column) : "none";
  const auto* list = v.as<Value::List>();
  if (!list) return "none";
  std::vector<std::string> items;
  size_t width = size_t(column) + 2;
  bool short_enough = true;
  for (const Value& item : *list) {
    items.push_back(value(item, member, indent + step, indent + step));
    width += items.back().size() + 2;
    short_enough = short_enough && items.back().find('\n') == std::string::npos;
  }
  if (short_enough && width <= line_width) return fmt::format("[{}]", fmt::join(items, ", "));
  std::string result = "[\n";
  for (const std::string& item : items) result.append(size_t(indent) + step, ' ').append(item) += ",\n";
  return result.append(size_t(indent), ' ') + "]";
}

}  // namespace etendue::language

namespace etendue {

std::string write_description(const Component& component, bool all, const std::string& folder) {
  return language::Writer(all, folder).description(component);
}

std::string write_value(const Value& value) { return language::Writer(false, {}).value(value, nullptr, 0, 0); }

}  // namespace etendue
