// Evaluator: evaluation of expressions, lists and names.

#include "evaluator.h"

#include <fmt/format.h>

#include <algorithm>

#include "describe/words.h"
#include "json.h"
#include "turns.h"

namespace etendue::language {

std::optional<Value> Evaluator::evaluate(Node& node, const Context& context) {
  if (depth_ >= height_limit) {
    diagnostics_.add(Error(fmt::format("definitions are nested too deeply: at most {} levels", height_limit), node.at));
    return std::nullopt;
  }
  if (repeating_ > 0) charge(1, node.at);
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
    case NodeType::numbers:
      if (node.json && context.member) return json_numbers(node, *context.member);
      if (repeating_ == 0) return Value(std::move(*node.numbers), node.at);
      charge(node.numbers->values.size(), node.at);
      return Value(*node.numbers, node.at);
    case NodeType::json_text: return json_text(node, context);
    case NodeType::string: {
      Value value(repeating_ == 0 ? std::move(node.text) : node.text, node.at);
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
      unknown_unit(label);
      return std::nullopt;
    }
    case NodeType::negation: {
      const std::optional<Value> inner = evaluate(node.children[0], {nullptr, false, context.lenient});
      if (!inner) return std::nullopt;
      return reporting(node.at, [&] { return negate(*inner, node.at); });
    }
    case NodeType::sum:
    case NodeType::product: return chain(node, context);
    case NodeType::power: {
      const Context plain{nullptr, false, context.lenient};
      const std::optional<Value> base = evaluate(node.children[0], plain), exponent = evaluate(node.children[1], plain);
      if (!base || !exponent) return std::nullopt;
      return reporting(node.labels[0].at, [&] {
        Value value = power(*base, *exponent, node.labels[0].at);
        value.location = node.at;
        return value;
      });
    }
    case NodeType::range: return range(node, context);
    case NodeType::comparison: return comparison(node, context);
    case NodeType::conjunction:
    case NodeType::disjunction:
    case NodeType::inversion: return connection(node, context);
    case NodeType::conditional: return conditional(node, context);
    case NodeType::index: return index(node, context);
    case NodeType::comprehension: return comprehension(node, context);
    case NodeType::argument:  // calls evaluate the child of an argument
    case NodeType::bad: break;
  }
  return std::nullopt;
}

void Evaluator::unknown_unit(const Label& label) {
  std::vector<std::string> known;
  for (const Unit& u : units()) known.emplace_back(u.name);
  std::string meant = translation(label.text, foreign_units());
  if (meant.empty()) meant = suggestion(label.text, known);
  if (meant.empty()) meant = fmt::format("; known are {}", fmt::join(known, ", "));
  diagnostics_.add(Error(fmt::format("unknown unit '{}'{}", label.text, meant), label.at));
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
    if (!good && repeating_ > 0) break;  // one error is enough where each entry may take long, or repeats it
  }
  if (!good) return std::nullopt;
  return reporting(node.at, [&] {
    Value whole = packed(std::move(items), node.at);
    if (const auto* nested = whole.as<Value::List>()) check_size(node, *nested);
    return whole;
  });
}

size_t value_count(const Value& value) {
  if (const auto* numbers = value.as<Numbers>()) return numbers->values.size();
  const auto* list = value.as<Value::List>();
  if (!list) return 1;
  size_t count = 0;
  for (const Value& item : *list) count += value_count(item);
  return count;
}

// Lists of numbers or rows are packed, and only as long as their text. Lists of named lists grow by a factor with each name:
// [a, a], [b, b], … (No member takes lists nested this deep, so a large one can only be a mistake.)
void Evaluator::check_size(const Node& node, const Value::List& list) const {
  size_t count = 0, most = 0, largest = 0;
  for (size_t i = 0; i < list.size(); ++i) {
    const size_t here = value_count(list[i]);
    count += here;
    if (here > most) most = here, largest = i;
  }
  const bool nested =
      std::any_of(list.begin(), list.end(), [](const Value& v) { return v.as<Value::List>() || v.as<Numbers>(); });
  if (!nested || count <= nested_limit) return;
  const Node& child = node.children[largest];
  const std::string whose = child.type == NodeType::name ? "'" + child.text + "'" : "its largest entry";
  throw Error(fmt::format("the list holds {} values, more than the {} that lists within lists may: {} alone holds {}", count,
                          nested_limit, whose, most),
              node.at);
}

std::optional<Value> Evaluator::call_function(Node& node, const Context& context) {
  Entry* own = find(node.text);
  if (own && own->definition.function) return call_own(*own, node, context);
  if (own && !is_function(node.text)) {
    not_a_function(*own, node);
    return std::nullopt;
  }
  if (node.text == "count") return count(node, context);
  std::vector<Value> arguments;
  bool good = true;
  for (Node& child : node.children) {
    if (child.type == NodeType::argument) {
      if (is_function(node.text))
        diagnostics_.add(
            Error(fmt::format("'{}' takes its arguments by their place: write the value alone", node.text), child.at));
      good = false;
      continue;
    }
    if (lacks_quotes(node, child, nullptr)) {
      good = false;
      continue;
    }
    std::optional<Value> argument = evaluate(child, {nullptr, false, context.lenient});
    if (argument)
      arguments.push_back(std::move(*argument));
    else
      good = false;
  }
  if (!is_function(node.text)) {
    unknown_function(node);
    return std::nullopt;
  }
  if (!good) return std::nullopt;
  std::optional<Value> value = reporting(node.at, [&] { return call(node.text, arguments, node.at, allow_files_); });
  if (!value) return value;
  if (repeating_ > 0) charge(value->as<Color>() ? 150 : 10, node.at);  // a colour may hold a table
  value->location = node.at;
  if (node.text == "rotate") note_turn(node, arguments);
  if (node.text == "keyframes" && !node.damaged) node.damaged = warn_of_long_turns(node);  // warned once
  return value;
}

// ---- names ----------------------------------------------------------------------------------------------------------

std::optional<Value> Evaluator::named(Entry& entry, Location at) {
  entry.used = true;
  if (entry.definition.function) {
    const std::string& called = entry.definition.name.text;
    diagnostics_.add(Error(fmt::format("'{0}' is a function: write {0}(…)", called), at));
    return std::nullopt;
  }
  if (entry.state == State::active) {
    std::string chain;
    const auto first = std::find(active_.begin(), active_.end(), &entry);
    for (auto i = first; i != active_.end(); ++i) chain += (*i)->definition.name.text + " → ";
    diagnostics_.add(Error(fmt::format("'{0}' is defined by itself: {1}{0}", entry.definition.name.text, chain), at));
    return std::nullopt;
  }
  if (entry.state == State::waiting) settle_with_all_it_needs(entry);
  if (entry.state == State::failed) return std::nullopt;
  if (depth_ + entry.height >= height_limit) {
    diagnostics_.add(Error(fmt::format("'{}' is nested too deeply: its parts go {} levels down, and it stands at level {}; {} "
                                       "levels are the most in all",
                                       entry.definition.name.text, entry.height, depth_, height_limit),
                           at));
    return std::nullopt;
  }
  reach_ = std::max(reach_, depth_ + entry.height);
  if (repeating_ > 0 || entry.generated) charge(copied_size(entry.value), at);
  Value value = entry.value;
  value.location = at;
  return value;
}

std::vector<Evaluator::Entry*> Evaluator::waiting_names(const Node& node, Space& space) {
  std::vector<Entry*> found;
  std::vector<const Node*> rest = {&node};
  while (!rest.empty()) {
    const Node& next = *rest.back();
    rest.pop_back();
    if (next.type == NodeType::name)
      if (Entry* entry = find(next.text, space); entry && !entry->definition.function && entry->state == State::waiting)
        found.push_back(entry);
    for (const Node& child : next.children) rest.push_back(&child);
  }
  return found;
}

// Evaluates the definitions that a definition depends on before it, with an explicit stack, so that a chain of a hundred
// thousand definitions does not need deep recursion. Cyclic definitions are left to the recursive evaluation, which reports
// them.
void Evaluator::settle_with_all_it_needs(Entry& first) {
  if (circle_) return settle(first);
  struct Step {
    Entry* entry;
    std::vector<Entry*> needs;
  };
  std::vector<Step> way;
  const auto visit = [&](Entry& entry) {
    entry.pending = true;
    way.push_back({&entry, waiting_names(entry.definition.value, *entry.space)});
  };
  visit(first);
  while (way.size() > 1 || !way.back().needs.empty()) {
    Step& step = way.back();
    if (step.needs.empty()) {
      step.entry->pending = false;
      Entry* entry = step.entry;
      way.pop_back();
      settle(*entry);
      continue;
    }
    Entry* next = step.needs.back();
    step.needs.pop_back();
    circle_ = next->pending;
    if (circle_) break;
    if (next->state == State::waiting) visit(*next);
  }
  for (const Step& step : way) step.entry->pending = false;
  if (first.state == State::waiting) settle(first);
  circle_ = false;
}

bool keeps_parts(const Value& value) {
  const auto* list = value.as<Value::List>();
  return list ? std::any_of(list->begin(), list->end(), keeps_parts) : value.as<Ref<Component>>() != nullptr;
}

void Evaluator::settle(Entry& entry) {
  if (entry.definition.function) {
    check_function(entry);
    return;
  }
  const Elsewhere elsewhere(*this, *entry.space);
  repeating_ = 0;
  const SpaceTrail trail(entry.home->label);
  diagnostics_.trail = &trail;
  entry.state = State::active;
  active_.push_back(&entry);
  const int outer = std::exchange(reach_, depth_);
  Node& node = entry.definition.value;
  entry.generated = node.type != NodeType::numbers && node.type != NodeType::list;
  std::optional<Value> value;
  if (node.type == NodeType::component) {
    ++depth_;
    value = component(node, given_name(entry));
    --depth_;
  } else {
    value = evaluate(node, {});
    // A component made by a function or a conditional gets the name of this definition.
    const auto* part = value ? value->as<Ref<Component>>() : nullptr;
    if (part && *part && (*part)->origin && (*part)->origin->name.empty() && node.type != NodeType::index)
      (*part)->origin->name = given_name(entry);
  }
  entry.height = value && !keeps_parts(*value) ? 0 : reach_ - depth_;
  reach_ = std::max(outer, reach_);
  active_.pop_back();
  entry.state = value ? State::done : State::failed;
  if (value) entry.value = std::move(*value);
  node = {};
}

}  // namespace etendue::language
