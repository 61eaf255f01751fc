// The values of JSON strings and lists of numbers, which depend on the type of their member.

#include <fmt/format.h>

#include <algorithm>

#include "etendue/describe/color.h"
#include "evaluator.h"
#include "json.h"

namespace etendue::language {

namespace {

/// Whether a member accepts a colour: it is a colour, or a component that can be made from a colour.
bool takes_color(const Member& member) {
  if (member.kind == Kind::color) return true;
  const ClassInfo* wanted = member.kind == Kind::component ? Registry::instance().find(member.component_class) : nullptr;
  if (!wanted) return false;
  for (const ClassInfo* info : Registry::instance().subclasses(*wanted)) {
    if (info->literal.empty()) continue;
    return info->find(info->literal)->kind == Kind::color;
  }
  return false;
}

}  // namespace

// Whether a JSON string is a text, as for members that are texts; otherwise it is an expression.
bool Evaluator::is_json_text(const Node& node, const Context& context) {
  const Member* member = context.member;
  if (!member) return false;
  if (member->kind == Kind::string || member->kind == Kind::file) return true;
  if (member->kind != Kind::choice) return false;
  const auto& choices = member->choices;
  if (std::find(choices.begin(), choices.end(), node.text) != choices.end()) return true;
  return !node.text.starts_with("if ") && !find(node.text) && !local(node.text);
}

std::optional<Value> Evaluator::json_text(Node& node, const Context& context) {
  if (is_json_text(node, context)) {
    Value value(node.text, node.at);
    value.folder = folders_[node.at.file];
    return value;
  }
  const std::unique_ptr<Node> expression = parse_json_string(node, diagnostics_);
  return expression ? evaluate(*expression, context) : std::nullopt;
}

// Three numbers are linear sRGB if a colour is expected, and twelve or sixteen are a matrix if a transform is.
std::optional<Value> Evaluator::json_numbers(Node& node, const Member& member) {
  const Numbers& numbers = *node.numbers;
  const auto color = [&](size_t i) {
    return rgb_color("srgb", numbers.values[i], numbers.values[i + 1], numbers.values[i + 2]);
  };
  if (takes_color(member) && !member.list && numbers.width == 1 && numbers.values.size() == 3)
    return reporting(node.at, [&] { return Value(color(0), node.at); });
  if (takes_color(member) && member.list && numbers.width == 3)
    return reporting(node.at, [&] {
      Value::List colors;
      for (size_t i = 0; i < numbers.values.size(); i += 3) colors.emplace_back(color(i), node.at);
      return Value(std::move(colors), node.at);
    });
  if (member.kind == Kind::transform)
    return reporting(node.at, [&] {
      Value flat(Numbers{numbers.values, 1, Dimension::none}, node.at);
      Value value = call("matrix", {std::move(flat)}, node.at, allow_files_);
      value.location = node.at;
      return value;
    });
  if (repeating_ == 0) return Value(std::move(*node.numbers), node.at);
  charge(numbers.values.size(), node.at);
  return Value(numbers, node.at);
}

}  // namespace etendue::language
