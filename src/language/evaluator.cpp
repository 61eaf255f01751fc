// Names, lists and the way through expressions.

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
    case NodeType::numbers:  // every node is evaluated once
      if (node.json && context.member) return json_numbers(node, *context.member);
      return Value(std::move(*node.numbers), node.at);
    case NodeType::json_text: return json_text(node, context);
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
      std::string meant = translation(label.text, foreign_units());
      if (meant.empty()) meant = suggestion(label.text, known);
      if (meant.empty()) meant = fmt::format("; known are {}", fmt::join(known, ", "));
      diagnostics_.add(Error(fmt::format("unknown unit '{}'{}", label.text, meant), label.at));
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
  return reporting(node.at, [&] {
    Value whole = packed(std::move(items), node.at);
    if (const auto* nested = whole.as<Value::List>()) check_size(node, *nested);
    return whole;
  });
}

namespace {

/// How many single values a list holds with all lists within it.
size_t entries(const Value& value) {
  if (const auto* numbers = value.as<Numbers>()) return numbers->values.size();
  const auto* list = value.as<Value::List>();
  if (!list) return 1;
  size_t count = 0;
  for (const Value& item : *list) count += entries(item);
  return count;
}

}  // namespace

// Lists of numbers or rows are packed, and as long as what was written. Lists of lists that are names grow by a factor from
// name to name: [a, a], [b, b], … (No member takes lists within lists within lists: it can only be a mistake.)
void Evaluator::check_size(const Node& node, const Value::List& list) const {
  size_t count = 0, most = 0, largest = 0;
  for (size_t i = 0; i < list.size(); ++i) {
    const size_t here = entries(list[i]);
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
  entry->replaced = true;
  const Source& source = replacements_.emplace_back(Source{at.file, {}, text});
  remember_text(source.name, text);
  set_folder(source.name, {});
  Node& value = entry->definition.value;
  const size_t begin = text.find_first_not_of(" \t\r\n");
  // A string of JSON is an expression; when that is a text, it is replaced by a text.
  if (value.type == NodeType::json_text && value.text.starts_with('"')) value.type = NodeType::string;
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
  if (choice && std::find(member->choices.begin(), member->choices.end(), text) != member->choices.end()) {
    if (const Entry* entry = find(text))
      warn(fmt::format("'{0}' is the choice here, not the '{0}' defined at {1}", text,
                       place(entry->definition.name.at, node.at)),
           node.at);
    return word();
  }
  if (text == "pi") return Value(Number{3.14159265358979323846}, node.at);
  if (Entry* entry = find(text)) return named(*entry, node.at);
  if (choice || context.words) return word();  // a choice that there is not is for the member to reject
  if (!context.lenient && !incomplete_) undefined(text, node.at);
  return std::nullopt;
}

void Evaluator::undefined(const std::string& text, Location at) {
  if (Registry::instance().find(text) && is_json(at.file)) {
    diagnostics_.add(Error(fmt::format("'{0}' is a class: write {{ \"class\": \"{0}\" }}", text), at));
  } else if (Registry::instance().find(text)) {
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
  Value value = entry.value;
  value.location = at;
  return value;
}

std::vector<Evaluator::Entry*> Evaluator::waiting_names(const Node& node) {
  std::vector<Entry*> found;
  std::vector<const Node*> rest = {&node};
  while (!rest.empty()) {
    const Node& next = *rest.back();
    rest.pop_back();
    if (next.type == NodeType::name)
      if (Entry* entry = find(next.text); entry && entry->state == State::waiting) found.push_back(entry);
    for (const Node& child : next.children) rest.push_back(&child);
  }
  return found;
}

// What a definition needs is settled before it, so that a chain of a hundred thousand definitions needs no deeper recursion
// than one. Where they go in a circle, recursion finds it and tells of it.
void Evaluator::settle_with_all_it_needs(Entry& first) {
  if (circle_) return settle(first);
  struct Step {
    Entry* entry;
    std::vector<Entry*> needs;
  };
  std::vector<Step> way;
  const auto visit = [&](Entry& entry) {
    entry.pending = true;
    way.push_back({&entry, waiting_names(entry.definition.value)});
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

namespace {

/// Whether a value refers to components; numbers, texts, colours and transforms are all there is of them.
bool keeps_parts(const Value& value) {
  const auto* list = value.as<Value::List>();
  return list ? std::any_of(list->begin(), list->end(), keeps_parts) : value.as<Ref<Component>>() != nullptr;
}

}  // namespace

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
  entry.height = value && !keeps_parts(*value) ? 0 : reach_ - depth_;
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
    if (entry->state == State::waiting) settle_with_all_it_needs(*entry);
  if (!diagnostics_.empty()) return;
  for (const Entry* entry : unused) {
    const Label& label = entry->definition.name;
    if (!entry->used && entry->replaced)
      warn(fmt::format("has no effect: nothing uses the param '{}'", label.text), {intern("-D " + label.text), 0, 0});
    else if (!entry->used && label.at.file == source)
      warn(fmt::format("'{}' is defined but not used", label.text), label.at);
  }
}

}  // namespace etendue::language
