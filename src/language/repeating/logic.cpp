// Evaluator: conditions, ranges and indices of lists.

#include <fmt/format.h>

#include <cmath>

#include "etendue/describe/component.h"
#include "language/evaluator.h"

namespace etendue::language {

namespace {

/// -1 for less, 0 for equal, 1 for greater.
int order(double a, double b) { return a < b ? -1 : (a > b ? 1 : 0); }

bool holds(const std::string& operation, int order) {
  if (operation == "==") return order == 0;
  if (operation == "!=") return order != 0;
  if (operation == "<") return order < 0;
  if (operation == "<=") return order <= 0;
  return operation == ">" ? order > 0 : order >= 0;
}

/// The value as an integer, if it is one of at most 2^53; otherwise nothing.
std::optional<std::int64_t> whole(const Value& value) {
  const auto* number = value.as<Number>();
  if (!number || number->dimension != Dimension::none || std::abs(number->value) > 0x1p53) return std::nullopt;
  const auto rounded = std::int64_t(std::floor(number->value));
  return double(rounded) == number->value ? std::optional(rounded) : std::nullopt;
}

std::string kind_of(const Value& value) {
  const auto* number = value.as<Number>();
  return number && number->dimension == Dimension::none ? fmt::format("{}", number->value) : value.kind();
}

constexpr double range_limit = 1'000'000;

}  // namespace

Value compare(const std::string& operation, const Value& a, const Value& b, Location at) {
  const auto *x = a.as<Number>(), *y = b.as<Number>();
  if (x && y && x->dimension == y->dimension) return Value(holds(operation, order(x->value, y->value)));
  const bool equality = operation == "==" || operation == "!=";
  const bool component = a.as<Ref<Component>>() || b.as<Ref<Component>>();
  const bool comparable = a.none() || b.none() || (a.data.index() == b.data.index() && !component && !x);
  if (!equality || !comparable)
    throw Error(fmt::format("cannot compare {} with {} by '{}'", a.kind(), b.kind(), operation), at);
  const auto* list_a = a.as<Numbers>();
  const auto* list_b = b.as<Numbers>();
  if (list_a && list_b && list_a->dimension != list_b->dimension)
    throw Error(fmt::format("cannot compare {} with {}: they have different dimensions", a.kind(), b.kind()), at);
  return Value(holds(operation, equal(a, b) ? 0 : 1));
}

Value whole_numbers(const Value& first, const Value& end, Location at) {
  for (const Value* value : {&first, &end})
    if (!whole(*value))
      throw Error(fmt::format("a range goes from a whole number to a whole number, not {}", kind_of(*value)), at);
  const std::int64_t from = *whole(first), to = *whole(end);
  if (double(to) - double(from) > range_limit)
    throw Error(fmt::format("the range has {} numbers, more than the 1000000 that one may", to - from), at);
  if (to <= from) return Value(Value::List());
  Numbers numbers;
  numbers.values.resize(size_t(to - from));
  for (size_t i = 0; i < numbers.values.size(); ++i) numbers.values[i] = double(from + std::int64_t(i));
  return Value(std::move(numbers));
}

size_t list_size(const Value& list, Location at) {
  if (const auto* numbers = list.as<Numbers>()) return numbers->rows();
  const auto* items = list.as<Value::List>();
  if (!items) throw Error(fmt::format("expected a list, not {}", list.kind()), at);
  return items->size();
}

Value list_entry(const Value& list, size_t place) {
  if (const auto* items = list.as<Value::List>()) return (*items)[place];
  const Numbers& numbers = *list.as<Numbers>();
  if (numbers.width == 1) return Value(Number{numbers.values[place], numbers.dimension}, list.location);
  const auto begin = numbers.values.begin() + long(place) * numbers.width;
  return Value(Numbers{{begin, begin + numbers.width}, 1, numbers.dimension}, list.location);
}

std::optional<Value> Evaluator::range(Node& node, const Context& context) {
  const Context plain{nullptr, false, context.lenient};
  const std::optional<Value> first = evaluate(node.children[0], plain), end = evaluate(node.children[1], plain);
  if (!first || !end) return std::nullopt;
  return reporting(node.labels[0].at, [&] {
    Value value = whole_numbers(*first, *end, node.labels[0].at);
    charge(copied_size(value), node.at);
    value.location = node.at;
    return value;
  });
}

std::optional<Value> Evaluator::comparison(Node& node, const Context& context) {
  const Context plain{nullptr, false, context.lenient};
  const std::optional<Value> a = evaluate(node.children[0], plain), b = evaluate(node.children[1], plain);
  if (!a || !b) return std::nullopt;
  const Label& operation = node.labels[0];
  return reporting(operation.at, [&] {
    Value value = compare(operation.text, *a, *b, operation.at);
    value.location = node.at;
    return value;
  });
}

std::optional<bool> Evaluator::truth(Node& node, const Context& context, const char* what) {
  const std::optional<Value> value = evaluate(node, {nullptr, false, context.lenient});
  if (!value) return std::nullopt;
  if (const auto* flag = value->as<bool>()) return *flag;
  diagnostics_.add(Error(fmt::format("{} must be true or false, not {}", what, value->kind()), node.at));
  return std::nullopt;
}

// and, or, not. Evaluation stops at the operand that decides; the names in later operands are checked all the same.
std::optional<Value> Evaluator::connection(Node& node, const Context& context) {
  if (repeating_ == 0 && !check(node, nullptr, context)) return std::nullopt;
  if (node.type == NodeType::inversion) {
    const std::optional<bool> inner = truth(node.children[0], context, "the operand of 'not'");
    return inner ? std::optional(Value(!*inner, node.at)) : std::nullopt;
  }
  const bool decisive = node.type == NodeType::disjunction;
  const char* what = decisive ? "an operand of 'or'" : "an operand of 'and'";
  for (Node& child : node.children) {
    const std::optional<bool> one = truth(child, context, what);
    if (!one) return std::nullopt;
    if (*one == decisive) return Value(decisive, node.at);
  }
  return Value(!decisive, node.at);
}

std::optional<Value> Evaluator::conditional(Node& node, const Context& context) {
  if (repeating_ == 0 && !check(node, nullptr, context)) return std::nullopt;
  const std::optional<bool> condition = truth(node.children[0], context, "the condition of 'if'");
  return condition ? evaluate(node.children[*condition ? 1 : 2], context) : std::nullopt;
}

std::optional<Value> Evaluator::index(Node& node, const Context& context) {
  const Context plain{nullptr, false, context.lenient};
  const Value* list = stored(node.children[0]);
  std::optional<Value> made;
  if (!list) {
    made = evaluate(node.children[0], plain);
    if (made) list = &*made;
  }
  const std::optional<Value> place = evaluate(node.children[1], plain);
  if (!list || !place) return std::nullopt;
  // The evaluation of the index may move the stored list, so it is looked up again.
  if (!made) list = stored(node.children[0]);
  return reporting(node.at, [&] {
    const size_t size = list_size(*list, node.at);
    const std::optional<std::int64_t> at = whole(*place);
    if (!at) throw Error(fmt::format("an index is a whole number, not {}", kind_of(*place)), node.children[1].at);
    if (*at < 0 || size_t(*at) >= size)
      throw Error(size == 0 ? std::string("the list is empty")
                            : fmt::format("there is no entry {}: the list has {}, from 0 to {}", *at, size, size - 1),
                  node.children[1].at);
    Value value = list_entry(*list, size_t(*at));
    if (repeating_ > 0) charge(copied_size(value), node.at);
    value.location = node.at;
    return value;
  });
}

}  // namespace etendue::language
