// Binder: makes components from component blocks.

#include <fmt/format.h>

#include <algorithm>

#include "describe/words.h"
#include "evaluator.h"

namespace etendue::language {

std::optional<Value> Evaluator::component(Node& node, const std::string& given_name) {
  Ref<Component> made;
  if (!incomplete_ || Registry::instance().find(node.text)) {
    reporting(node.at, [&] {
      made = Registry::instance().create(node.text);
      return Value();
    });
  }
  if (!made) {  // reports errors in its members, too
    for (Node& child : node.children) evaluate(child, {nullptr, false, true});
    return std::nullopt;
  }
  if (repeating_ > 0) charge_part(node.at);
  made->origin = std::make_unique<Component::Origin>();
  made->origin->location = node.at;
  made->origin->name = given_name;
  if (!set_members(*made, node)) return std::nullopt;
  return Value(std::move(made), node.at);
}

bool Evaluator::set_members(Component& made, Node& node) {
  const ClassInfo& info = made.class_info();
  bool good = true;
  for (size_t i = 0; i < node.children.size(); ++i) {
    const Label& label = node.labels[i];
    Node& child = node.children[i];
    const Location at = child.at;
    const Member* member = info.find(label.text);
    if (!member) {
      diagnostics_.add(Error(no_member(info, label.text), label.at));
      evaluate(child, {nullptr, false, true});
      good = false;
      continue;
    }
    made.origin->members.emplace_back(label.text, at.known() ? at : label.at);
    const std::optional<Value> value = evaluate(child, {member});
    const std::optional<Value> stored = !value ? std::nullopt : reporting(at, [&] {
      set(made, label.text, *value);
      return Value();
    });
    if (!stored) good = false;
  }
  if (node.damaged) return false;  // a required member may be in the part that could not be read
  for (const Member& member : info.members) {
    const auto wrote = [&](const Label& label) { return label.text == member.name; };
    if (!member.required || std::any_of(node.labels.begin(), node.labels.end(), wrote)) continue;
    diagnostics_.add(Error(fmt::format("{} needs '{}'", info.name, member.name), node.at));
    good = false;
  }
  return good;
}

}  // namespace etendue::language
