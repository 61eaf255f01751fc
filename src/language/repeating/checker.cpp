// Evaluator: checks of names, classes, members, units and functions in expressions that may be evaluated many times, or never.
// Each error is reported once, whatever the values of conditions and arguments.

#include <fmt/format.h>

#include <algorithm>

#include "describe/words.h"
#include "language/evaluator.h"
#include "language/json.h"

namespace etendue::language {

bool Evaluator::check_function(Entry& entry) {
  if (entry.state != State::waiting) return entry.state != State::failed;
  entry.state = State::active;
  const Elsewhere elsewhere(*this, *entry.space);
  diagnostics_.trail = nullptr;
  std::vector<Parameter>& parameters = entry.definition.parameters;
  std::vector<Bound> names(parameters.size());
  const Bound* before = nullptr;
  bool good = true;
  for (size_t i = 0; i < names.size(); ++i) {
    if (parameters[i].standard) good = check(*parameters[i].standard, before, {}) && good;
    names[i].name = parameters[i].name.text;
    names[i].outer = before;
    before = &names[i];
  }
  good = check(entry.definition.value, before, {}) && good;
  for (size_t i = 0; i < names.size(); ++i)
    if (!names[i].used) unused_parameters_.push_back(parameters[i].name);
  entry.state = good ? State::done : State::failed;
  return good;
}

bool Evaluator::check(Node& node, const Bound* bound, const Context& context) {
  const Context plain{nullptr, false, context.lenient};
  switch (node.type) {
    case NodeType::bad: return false;
    case NodeType::name: return check_name(node, bound, context);
    case NodeType::call: return check_call(node, bound, context);
    case NodeType::component: return check_component(node, bound, context);
    case NodeType::comprehension: return check_comprehension(node, bound, context);
    case NodeType::list: return check_all(node.children, bound, context);
    case NodeType::unit:
      if (!find_unit(node.labels[0].text)) {
        unknown_unit(node.labels[0]);
        return false;
      }
      return check(node.children[0], bound, plain);
    case NodeType::conditional: {
      const bool condition = check(node.children[0], bound, plain), then = check(node.children[1], bound, context);
      return check(node.children[2], bound, context) && condition && then;
    }
    case NodeType::json_text: {
      for (const Bound* one = bound; one; one = one->outer)
        if (one->name == node.text && context.member && context.member->kind == Kind::choice) return one->used = true;
      if (is_json_text(node, context)) return true;
      const std::unique_ptr<Node> expression = parse_json_string(node, diagnostics_);
      if (!expression) return false;
      node = std::move(*expression);
      return check(node, bound, context);
    }
    default: return check_all(node.children, bound, plain);
  }
}

bool Evaluator::check_all(std::vector<Node>& nodes, const Bound* bound, const Context& context) {
  bool good = true;
  for (Node& node : nodes) good = check(node, bound, context) && good;
  return good;
}

bool Evaluator::check_name(const Node& node, const Bound* bound, const Context& context) {
  const std::string& text = node.text;
  const bool choice = context.member && context.member->kind == Kind::choice;
  if (choice && std::ranges::find(context.member->choices, text) != context.member->choices.end()) return true;
  for (const Bound* one = bound; one; one = one->outer)
    if (one->name == text) return one->used = true;
  if (local(text) || text == "pi") return true;
  if (Entry* entry = find(text)) {
    entry->used = true;
    if (!entry->definition.function) return true;
    diagnostics_.add(Error(fmt::format("'{0}' is a function: write {0}(…)", text), node.at));
    return false;
  }
  if ((moment_ && (text == "frame" || text == "time")) || choice || context.words) return true;
  const Bound* outer = std::exchange(bound_, bound);
  if (!context.lenient && !incomplete_) undefined(text, node.at);
  bound_ = outer;
  return false;
}

bool Evaluator::check_call(Node& node, const Bound* bound, const Context& context) {
  bool good = true;
  Entry* own = find(node.text);
  if (own) own->used = own->used || own->definition.function;
  if (own && own->definition.function) {
    good = arguments_of(*own, node).has_value();
  } else if (own && !is_function(node.text)) {
    not_a_function(*own, node);
    good = false;
  } else if (!is_function(node.text)) {
    unknown_function(node);
    good = false;
  }
  for (Node& child : node.children) {
    Node& value = child.type == NodeType::argument ? child.children[0] : child;
    if (lacks_quotes(node, child, bound)) {
      good = false;
      continue;
    }
    good = check(value, bound, {nullptr, false, context.lenient}) && good;
  }
  return good;
}

bool Evaluator::check_component(Node& node, const Bound* bound, const Context& context) {
  const ClassInfo* info = Registry::instance().find(node.text);
  bool good = info && !node.damaged;
  if (!info && !incomplete_)
    reporting(node.at, [&] { return Value(Registry::instance().create(node.text)); });  // throws Error: there is no such class
  for (size_t i = 0; i < node.children.size(); ++i) {
    const Member* member = info ? info->find(node.labels[i].text) : nullptr;
    if (info && !member) {
      diagnostics_.add(Error(no_member(*info, node.labels[i].text), node.labels[i].at));
      good = false;
    }
    good = check(node.children[i], bound, {member, false, context.lenient || !member}) && good;
  }
  return good;
}

bool Evaluator::check_comprehension(Node& node, const Bound* bound, const Context& context) {
  std::vector<Bound> names(node.labels.size());
  bool good = true;
  const Bound* before = bound;
  for (size_t i = 0; i < names.size(); ++i) {
    good = check(node.children[i + 1], before, {nullptr, false, context.lenient}) && good;
    if (node.labels[i].text.empty()) continue;
    names[i].name = node.labels[i].text;
    names[i].outer = before;
    before = &names[i];
  }
  return check(node.children[0], before, context) && good;
}

}  // namespace etendue::language
