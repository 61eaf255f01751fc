// Evaluator: list comprehensions, and limits of the work in them.

#include <fmt/format.h>

#include <algorithm>

#include "etendue/language/language.h"
#include "language/evaluator.h"

namespace etendue::language {

/// The state of one evaluation of a comprehension.
struct Evaluator::Loop {
  Node& node;
  const Context& context;
  /// The lists of clauses that do not depend on loop variables; evaluated once.
  std::vector<std::optional<Value>> lists;
  std::vector<int> heights;  // of the component trees in them
  Value::List entries = {};
  size_t turns = 0;   // iterations of the innermost loop
  size_t values = 0;  // values in the entries, with nested lists

  size_t clauses() const { return node.labels.size(); }
  bool is_condition(size_t clause) const { return node.labels[clause].text.empty(); }
  Node& of(size_t clause) const { return node.children[clause + 1]; }
};

class Evaluator::LoopTrail : public Trail {
 public:
  LoopTrail(const Trail* outer, const Local& local) : Trail(outer), local_(local) {}
  std::string words(const Location&) const override {
    const Value& value = local_.value;
    const bool short_text = value.as<Number>() || value.as<bool>();
    return short_text ? fmt::format("with {} = {}", local_.name, write_value(value))
                      : fmt::format("with {} = entry {} of its list", local_.name, local_.place);
  }

 private:
  const Local& local_;
};

namespace {

/// Whether one of the names occurs in an expression; `looked_at` is increased by the number of visited nodes.
bool mentions(const Node& node, const std::vector<std::string_view>& names, size_t& looked_at) {
  std::vector<const Node*> rest = {&node};
  for (; !rest.empty(); ++looked_at) {
    const Node& next = *rest.back();
    rest.pop_back();
    // A JSON string may be any expression.
    if (next.type == NodeType::json_text && !names.empty()) return true;
    if (next.type == NodeType::name && std::find(names.begin(), names.end(), next.text) != names.end()) return true;
    for (const Node& child : next.children) rest.push_back(&child);
  }
  return false;
}

}  // namespace

// When a limit is exceeded, everything is given up: results so far are not used.
void Evaluator::charge(size_t steps, Location at) {
  steps_ += std::min(steps, step_limit);
  if (steps_ <= step_limit) return;
  diagnostics_.add(Error(fmt::format("too much work: comprehensions, functions and ranges may take {} steps in all, of which "
                                     "each number, name and operation that is evaluated is one",
                                     step_limit),
                         at));
  throw TooManyErrors{};
}

void Evaluator::charge_part(Location at) {
  charge(10, at);
  if (++parts_ <= part_limit) return;
  diagnostics_.add(Error(fmt::format("too many components: comprehensions and functions may make {} in all", part_limit), at));
  throw TooManyErrors{};
}

std::optional<Value> Evaluator::comprehension(Node& node, const Context& context) {
  if (repeating_ == 0 && !check(node, nullptr, context)) return std::nullopt;
  ++repeating_;
  Loop loop{node, context, std::vector<std::optional<Value>>(node.labels.size()), std::vector<int>(node.labels.size())};
  const bool good = foresee(loop) && run(loop, 0);
  --repeating_;
  if (!good) return std::nullopt;
  return reporting(node.at, [&] { return packed(std::move(loop.entries), node.at); });
}

// Evaluates the lists that do not depend on loop variables, and rejects too many iterations in advance.
bool Evaluator::foresee(Loop& loop) {
  std::vector<std::string_view> names;
  double turns = 1;
  bool known = true;  // whether the number of iterations is known so far
  for (size_t i = 0; i < loop.clauses(); ++i) {
    size_t looked_at = 0;
    const bool condition = loop.is_condition(i), free = !condition && !mentions(loop.of(i), names, looked_at);
    charge(looked_at, loop.node.at);
    known = known && free;
    if (!condition) names.push_back(loop.node.labels[i].text);
    if (!free) continue;
    loop.lists[i] = measured(loop.of(i), {nullptr, false, loop.context.lenient}, loop.heights[i]);
    if (!loop.lists[i]) return false;
    const Location at = loop.of(i).at;
    const auto counted = reporting(at, [&] { return Value(Number{double(list_size(*loop.lists[i], at))}); });
    if (!counted) return false;
    if (known) turns *= counted->as<Number>()->value;
  }
  if (turns <= double(repetition_limit)) return true;
  diagnostics_.add(
      Error(fmt::format("the list would have {:.6g} entries, more than the {} that 'for' may make", turns, repetition_limit),
            loop.node.at));
  return false;
}

// Runs the clauses from `clause` on. Returns false after an error in one iteration, since others would mostly repeat it.
bool Evaluator::run(Loop& loop, size_t clause) {
  if (clause == loop.clauses()) return take_entry(loop);
  if (loop.is_condition(clause)) {
    const std::optional<bool> condition = truth(loop.of(clause), loop.context, "the condition of 'if'");
    return condition && (!*condition || run(loop, clause + 1));
  }
  const Label& name = loop.node.labels[clause];
  std::optional<Value> made;
  int height = loop.heights[clause];
  const Value* list = loop.lists[clause] ? &*loop.lists[clause] : nullptr;
  if (!list) {
    made = measured(loop.of(clause), {nullptr, false, loop.context.lenient}, height);
    if (!made) return false;
    list = &*made;
  }
  const Location at = loop.of(clause).at;
  const auto size = reporting(at, [&] { return Value(Number{double(list_size(*list, at))}); });
  if (!size) return false;
  Local local{name.text, {}, height, 0, locals_};
  const LoopTrail trail(diagnostics_.trail, local);
  locals_ = &local;
  diagnostics_.trail = &trail;
  bool good = true;
  for (size_t i = 0; good && i < size_t(size->as<Number>()->value); ++i) {
    charge(1, at);
    local.value = list_entry(*list, i);
    local.place = i;
    good = run(loop, clause + 1);
  }
  diagnostics_.trail = trail.outer();
  locals_ = local.outer;
  return good;
}

bool Evaluator::take_entry(Loop& loop) {
  if (++loop.turns > repetition_limit) {
    diagnostics_.add(
        Error(fmt::format("the list has more than the {} entries that 'for' may make", repetition_limit), loop.node.at));
    return false;
  }
  std::optional<Value> entry = evaluate(loop.node.children[0], loop.context);
  if (!entry) return false;
  if (!entry->as<Number>()) charge(8, loop.node.at);  // numbers are packed at the end, other values take memory
  loop.values += value_count(*entry);
  if (loop.values > nested_limit) {
    diagnostics_.add(
        Error(fmt::format("the list holds more than the {} values that lists within lists may", nested_limit), loop.node.at));
    return false;
  }
  loop.entries.push_back(std::move(*entry));
  return true;
}

}  // namespace etendue::language
