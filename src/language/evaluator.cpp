// Names, lists and the way through expressions.

#include "language/evaluator.h"

#include <fmt/format.h>

#include <algorithm>

#include "language/turns.h"

namespace etendue::language {

std::optional<Value> Evaluator::evaluate(Node& node, const Context& context) {
  if (depth_ >= height_limit) {
    diagnostics_.add(Error("definitions are nested too deeply", node.at));
    return std::nullopt;
  }
  ++depth_;
  reach_ = std::max(reach_, depth_);
  std::optional<Value> value = value_of(node, context);
  --depth_;
  return value;
}

std::optional<Value> Evaluator::value_of(Node& node, const Context& context) {
  switch (node.type) {
    case NodeType::none: return Value(std::monostate(), node.at);
    case NodeType::boolean: return Value(node.number != 0, node.at);
    case NodeType::number: return Value(Number{node.number}, node.at);
    case NodeType::numbers: return Value(std::move(*node.numbers), node.at);  // every node is evaluated once
    case NodeType::string: {
      Value value(std::move(node.text), node.at);
      value.folder = folders_[node.at.file];
      return value;
    }
    case NodeType::name: return name(node, context);
    case NodeType::list: return list(node, context);
    case NodeType::call: return call_function(node, context);
    case NodeType::component: return component(node, {});
    case NodeType::unit: {
      std::optional<Value> inner = evaluate(node.children[0], {nullptr, false, context.lenient});
      if (!inner) return inner;
      const Label& label = node.labels[0];
      const Unit* unit = find_unit(label.text);
      if (unit) return reporting(label.at, [&] { return with_unit(std::move(*inner), *unit, label.at); });
      std::vector<std::string> known;
      for (const Unit& u : units()) known.emplace_back(u.name);
      diagnostics_.add(Error(fmt::format("unknown unit '{}'{}", label.text, suggestion(label.text, known)), label.at));
      return std::nullopt;
    }
    case NodeType::negation: {
      const std::optional<Value> inner = evaluate(node.children[0], {nullptr, false, context.lenient});
      if (!inner) return std::nullopt;
      return reporting(node.at, [&] { return negate(*inner, node.at); });
    }
    case NodeType::sum:
    case NodeType::product: return chain(node, context);
    case NodeType::bad: break;
  }
  return std::nullopt;
}

std::optional<Value> Evaluator::chain(Node& node, const Context& context) {
  const Context plain{nullptr, false, context.lenient};
  std::optional<Value> left = evaluate(node.children[0], plain);
  for (size_t i = 1; i < node.children.size(); ++i) {
    const std::optional<Value> right = evaluate(node.children[i], plain);
    if (!left || !right) {
      left.reset();
      continue;
    }
    const Label& operation = node.labels[i - 1];
    left = reporting(operation.at, [&] {
      switch (operation.text.front()) {
        case '+': return add(*left, *right, operation.at);
        case '-': return subtract(*left, *right, operation.at);
        case '*': return multiply(*left, *right, operation.at);
        default: return divide(*left, *right, operation.at);
      }
    });
  }
  if (left) left->location = node.at;
  return left;
}

std::optional<Value> Evaluator::list(Node& node, const Context& context) {
  Value::List items;
  items.reserve(node.children.size());
  bool good = true;
  for (Node& child : node.children) {
    std::optional<Value> item = evaluate(child, context);
    if (item)
      items.push_back(std::move(*item));
    else
      good = false;
  }
  if (!good) return std::nullopt;
  return reporting(node.at, [&] { return packed(std::move(items), node.at); });
}

std::optional<Value> Evaluator::call_function(Node& node, const Context& context) {
  std::vector<Value> arguments;
  bool good = true;
  for (Node& child : node.children) {
    std::optional<Value> argument = evaluate(child, {nullptr, false, context.lenient});
    if (argument)
      arguments.push_back(std::move(*argument));
    else
      good = false;
  }
  if (!good && is_function(node.text)) return std::nullopt;
  std::optional<Value> value = reporting(node.at, [&] { return call(node.text, arguments, node.at, allow_files_); });
  if (!value) return value;
  value->location = node.at;
  if (node.text == "rotate") note_turn(node, arguments);
  if (node.text == "keyframes") warn_of_long_turns(node);
  return value;
}

// ---- names ----------------------------------------------------------------------------------------------------------

void Evaluator::define(Definition definition) {
  const Label label = definition.name;
  if (const Entry* first = find(label.text)) {
    if (definition.value.type != NodeType::bad)
      diagnostics_.add(Error(
          fmt::format("'{}' is already defined at {}", label.text, place(first->definition.name.at, label.at)), label.at));
    return;
  }
  entries_.emplace_back().definition = std::move(definition);
  by_name_[label.text] = &entries_.back();
}

void Evaluator::redefine(const std::string& name, const std::string& text) {
  const Location at{intern("-D " + name), 0, 0};
  Entry* entry = find(name);
  if (!entry || !entry->definition.parameter) {
    std::vector<std::string> known;
    for (const Entry& e : entries_)
      if (e.definition.parameter) known.push_back(e.definition.name.text);
    const std::string wrong = entry ? "'{}' is not a param: only those can be replaced{}" : "there is no param '{}'{}";
    diagnostics_.add(Error(fmt::format(fmt::runtime(wrong), name, suggestion(name, known)), at));
    return;
  }
  const Source& source = replacements_.emplace_back(Source{at.file, {}, text});
  remember_text(source.name, text);
  set_folder(source.name, {});
  Node& value = entry->definition.value;
  const size_t begin = text.find_first_not_of(" \t\r\n");
  if (value.type == NodeType::string && (begin == std::string::npos || text[begin] != '"')) {
    value.text = text;
    value.at = {source.name, 1, 1};
    return;
  }
  if (const auto wrong = invalid_utf8(text)) {
    diagnostics_.add(Error("is not valid UTF-8", at));
    value.type = NodeType::bad;
    return;
  }
  if (auto parsed = parse_expression(source, diagnostics_))
    value = std::move(*parsed);
  else
    value.type = NodeType::bad;
}

Evaluator::Entry* Evaluator::find(const std::string& name) {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : found->second;
}

std::optional<Value> Evaluator::name(Node& node, const Context& context) {
  const std::string& text = node.text;
  const auto word = [&] {
    Value value(text, node.at);
    value.folder = folders_[node.at.file];
    return value;
  };
  const Member* member = context.member;
  const bool choice = member && member->kind == Kind::choice;
  if (choice && std::find(member->choices.begin(), member->choices.end(), text) != member->choices.end()) return word();
  if (text == "pi") return Value(Number{3.14159265358979323846}, node.at);
  if (Entry* entry = find(text)) return named(*entry, node.at);
  if (choice || context.words) return word();  // a choice that there is not is for the member to reject
  if (!context.lenient && !incomplete_) undefined(text, node.at);
  return std::nullopt;
}

void Evaluator::undefined(const std::string& text, Location at) {
  if (Registry::instance().find(text)) {
    diagnostics_.add(Error(fmt::format("'{0}' is a class: write {0} {{}}", text), at));
  } else if (is_function(text)) {
    diagnostics_.add(Error(fmt::format("'{0}' is a function: write {0}(…)", text), at));
  } else {
    std::vector<std::string> known = {"true", "false", "none", "pi"};
    for (const Entry& e : entries_) known.push_back(e.definition.name.text);
    diagnostics_.add(Error(fmt::format("'{}' is not defined{}", text, suggestion(text, known)), at));
  }
}

std::optional<Value> Evaluator::named(Entry& entry, Location at) {
  entry.used = true;
  if (entry.state == State::active) {
    std::string chain;
    const auto first = std::find(active_.begin(), active_.end(), &entry);
    for (auto i = first; i != active_.end(); ++i) chain += (*i)->definition.name.text + " → ";
    diagnostics_.add(Error(fmt::format("'{0}' is defined by itself: {1}{0}", entry.definition.name.text, chain), at));
    return std::nullopt;
  }
  if (entry.state == State::waiting) settle(entry);
  if (entry.state == State::failed) return std::nullopt;
  if (depth_ + entry.height >= height_limit) {
    diagnostics_.add(Error("definitions are nested too deeply", at));
    return std::nullopt;
  }
  reach_ = std::max(reach_, depth_ + entry.height);
  Value value = entry.value;
  value.location = at;
  return value;
}

void Evaluator::settle(Entry& entry) {
  entry.state = State::active;
  active_.push_back(&entry);
  const int outer = std::exchange(reach_, depth_);
  Node& node = entry.definition.value;
  std::optional<Value> value;
  if (node.type == NodeType::component) {
    ++depth_;
    value = component(node, entry.definition.name.text);
    --depth_;
  } else {
    value = evaluate(node, {});
  }
  entry.height = reach_ - depth_;
  reach_ = std::max(outer, reach_);
  active_.pop_back();
  entry.state = value ? State::done : State::failed;
  if (value) entry.value = std::move(*value);
  node = {};
}

void Evaluator::check_unused(const char* source) {
  std::vector<Entry*> unused;
  for (Entry& entry : entries_)
    if (!entry.used) unused.push_back(&entry);
  for (Entry* entry : unused)
    if (entry->state == State::waiting) settle(*entry);
  if (!diagnostics_.empty()) return;
  for (const Entry* entry : unused) {
    const Label& label = entry->definition.name;
    if (!entry->used && label.at.file == source) warn(fmt::format("'{}' is defined but not used", label.text), label.at);
  }
}

}  // namespace etendue::language
