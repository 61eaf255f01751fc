// The type and value of a member as text and as JSON.

#include "reflection_values.h"

#include <fmt/format.h>

#include <cmath>

namespace etendue {

namespace {

/// Converts from base units to the member's unit.
double in_unit(double value, Dimension dimension, const Member& member) {
  const Unit* unit = dimension == Dimension::none ? nullptr : find_unit(member.unit);
  return unit ? value / unit->factor : value;
}

/// The text of a number after a conversion to base units and back. Most members are floats: the shortest text that gives the
/// same float. Other numbers have the digits that remain exact.
std::string number_text(double value) {
  if (std::floor(value) == value && std::abs(value) < 1e15) return fmt::format("{}", static_cast<std::int64_t>(value));
  const float narrow = static_cast<float>(value);
  if (std::isfinite(narrow) && std::abs(double(narrow) - value) <= 1e-13 * std::abs(value)) return fmt::format("{}", narrow);
  return fmt::format("{:.15g}", value);
}

nlohmann::ordered_json number_json(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (std::floor(value) == value && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return std::stod(number_text(value));
}

std::string with_unit(const std::string& text, Dimension dimension, const Member& member) {
  return dimension == Dimension::none || !find_unit(member.unit) ? text : text + " " + member.unit;
}

std::string quoted(const std::string& text) {
  std::string r = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') r += '\\';
    if (c == '\n')
      r += "\\n";
    else
      r += c;
  }
  return r + "\"";
}

std::string transform_text(const Transform& transform) {
  if (transform.identity()) return "identity";
  std::vector<std::string> numbers;
  for (const double x : transform.exact()) numbers.push_back(number_text(x));
  return fmt::format("matrix({})", fmt::join(numbers, ", "));
}

std::string rows_text(const Numbers& numbers, const Member& member) {
  std::vector<std::string> rows;
  const size_t width = size_t(numbers.width);
  constexpr size_t most = 12;
  for (size_t row = 0; row < std::min(numbers.rows(), most); ++row) {
    std::vector<std::string> row_numbers;
    for (size_t i = 0; i < width; ++i)
      row_numbers.push_back(number_text(in_unit(numbers.values[row * width + i], numbers.dimension, member)));
    const std::string text = fmt::format("{}", fmt::join(row_numbers, ", "));
    rows.push_back(width == 1 ? text : "[" + text + "]");
  }
  if (numbers.rows() > most) rows.push_back(fmt::format("… {} in all", numbers.rows()));
  return with_unit(fmt::format("[{}]", fmt::join(rows, ", ")), numbers.values.empty() ? Dimension::none : numbers.dimension,
                   member);
}

/// The members of a component that differ from their defaults.
std::vector<std::pair<const Member*, Value>> chosen_members(const Component& component) {
  std::vector<std::pair<const Member*, Value>> chosen;
  for (const Member& member : component.class_info().members) {
    Value value = member.get(component, member);
    if (!equal(value, member.default_value)) chosen.emplace_back(&member, std::move(value));
  }
  return chosen;
}

std::string component_text(const Component& component) {
  const ClassInfo& info = component.class_info();
  // A component of a class with a literal is written as its plain value: 0.5 instead of ConstantMap { value: 0.5 }.
  if (!info.literal.empty()) {
    if (const Member* member = info.find(info.literal)) return value_text(member->get(component, *member), *member);
  }
  std::vector<std::string> parts;
  for (const auto& [member, value] : chosen_members(component))
    parts.push_back(member->name + ": " + value_text(value, *member));
  return parts.empty() ? info.name + " {}" : fmt::format("{} {{ {} }}", info.name, fmt::join(parts, ", "));
}

nlohmann::ordered_json component_json(const Component& component) {
  nlohmann::ordered_json json;
  json["class"] = component.class_info().name;
  for (const auto& [member, value] : chosen_members(component)) json[member->name] = value_json(value, *member);
  return json;
}

}  // namespace

const ClassInfo* parent_of(const ClassInfo& info) {
  return info.parent && info.parent->type != typeid(Component) ? info.parent : nullptr;
}

bool is_interface(const ClassInfo& info) { return info.abstract() || !parent_of(info); }

std::vector<const ClassInfo*> described_classes() {
  std::vector<const ClassInfo*> all = Registry::instance().all();
  std::erase_if(all, [](const ClassInfo* info) { return info->type == typeid(Component); });
  return all;
}

std::vector<const ClassInfo*> children(const ClassInfo& info) {
  std::vector<const ClassInfo*> found;
  for (const ClassInfo* other : described_classes())
    if (other->parent == &info) found.push_back(other);
  return found;
}

std::vector<const ClassInfo*> makeable(const ClassInfo& info) {
  std::vector<const ClassInfo*> found;
  for (const ClassInfo* other : described_classes())
    if (!other->abstract() && (other == &info || other->is_a(info))) found.push_back(other);
  return found;
}

std::string type_text(const Member& member) {
  std::string type;
  switch (member.kind) {
    case Kind::boolean: type = "true or false"; break;
    case Kind::integer: type = "integer"; break;
    case Kind::number: type = "number"; break;
    case Kind::string: type = "string"; break;
    case Kind::file: type = "file"; break;
    case Kind::choice: type = "choice"; break;
    case Kind::vector2: type = "2-vector"; break;
    case Kind::vector3: type = "vector"; break;
    case Kind::point3: type = "point"; break;
    case Kind::normal3: type = "normal"; break;
    case Kind::color: type = "colour"; break;
    case Kind::transform: type = "transform"; break;
    case Kind::component: type = member.component_class; break;
  }
  return member.list ? "list of " + type : type;
}

std::string unit_text(const Member& member) { return member.unit == "1" ? "" : member.unit; }

std::string value_text(const Value& value, const Member& member) {
  if (const auto* flag = value.as<bool>()) return *flag ? "true" : "false";
  if (const auto* number = value.as<Number>())
    return with_unit(number_text(in_unit(number->value, number->dimension, member)), number->dimension, member);
  if (const auto* text = value.as<std::string>()) return member.kind == Kind::choice ? *text : quoted(*text);
  if (const auto* numbers = value.as<Numbers>()) return rows_text(*numbers, member);
  if (const auto* file = value.as<FilePath>()) return quoted(file->text);
  if (const auto* color = value.as<Color>()) return *color ? (*color)->expression() : "none";
  if (const auto* transform = value.as<Transform>()) return transform_text(*transform);
  if (const auto* moving = value.as<AnimatedTransform>()) {
    if (!moving->animated()) return transform_text(moving->keys().front().transform);
    return fmt::format("{} keys in time", moving->keys().size());
  }
  if (const auto* component = value.as<Ref<Component>>()) return *component ? component_text(**component) : "none";
  if (const auto* list = value.as<Value::List>()) {
    std::vector<std::string> items;
    for (const Value& item : *list) items.push_back(value_text(item, member));
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  return "none";
}

nlohmann::ordered_json value_json(const Value& value, const Member& member) {
  if (const auto* flag = value.as<bool>()) return *flag;
  if (const auto* number = value.as<Number>()) return number_json(in_unit(number->value, number->dimension, member));
  if (const auto* text = value.as<std::string>()) return *text;
  if (const auto* numbers = value.as<Numbers>()) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    const size_t width = size_t(numbers->width);
    for (size_t i = 0; i < numbers->values.size(); ++i) {
      const auto x = number_json(in_unit(numbers->values[i], numbers->dimension, member));
      if (width == 1) {
        rows.push_back(x);
        continue;
      }
      if (i % width == 0) rows.push_back(nlohmann::ordered_json::array());
      rows.back().push_back(x);
    }
    return rows;
  }
  if (const auto* file = value.as<FilePath>()) return file->text;
  if (const auto* component = value.as<Ref<Component>>())
    return *component ? component_json(**component) : nlohmann::ordered_json(nullptr);
  if (const auto* list = value.as<Value::List>()) {
    nlohmann::ordered_json items = nlohmann::ordered_json::array();
    for (const Value& item : *list) items.push_back(value_json(item, member));
    return items;
  }
  if (value.none()) return nullptr;
  const std::string text = value_text(value, member);
  return text == "none" ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

}  // namespace etendue
