// Functions of numbers and lists.

#include <bit>
#include <cmath>
#include <cstdint>

#include "calls.h"

namespace etendue::language {

namespace {

const Number& any_number(const Arguments& a, size_t i) {
  const auto* n = a.as<Number>(i);
  if (!n) a.wrong(i, "a number");
  return *n;
}

Value plain(const Arguments& a, double x) {
  if (!std::isfinite(x)) a.fail(a.count(), "the result is not a finite number");
  return Value(Number{x});
}

Value square_root(const Arguments& a) {
  if (a.count() != 1) a.wrong_count();
  const double x = a.number(0);
  if (x < 0) a.fail(0, "the root of a negative number");
  return plain(a, std::sqrt(x));
}

/// An angle with a unit. Plain numbers throw Error: they could be meant as degrees or as radians.
double angle(const Arguments& a) {
  if (a.count() != 1) a.wrong_count();
  const auto* n = a.as<Number>(0);
  if (!n || n->dimension != Dimension::angle) a.wrong(0, "an angle with its unit, deg or rad");
  return n->value;
}

template <class Better>
Value extreme(const Arguments& a, Better better) {
  if (a.count() == 0) a.wrong_count();
  Number best = any_number(a, 0);
  for (size_t i = 1; i < a.count(); ++i) {
    const Number& n = any_number(a, i);
    if (n.dimension != best.dimension)
      a.wrong(i, best.dimension == Dimension::none ? "a plain number" : "a " + std::string(name(best.dimension)));
    if (better(n.value, best.value)) best = n;
  }
  return Value(best);
}

Value absolute(const Arguments& a) {
  if (a.count() != 1) a.wrong_count();
  const Number& n = any_number(a, 0);
  return Value(Number{std::abs(n.value), n.dimension});
}

Value power(const Arguments& a) {
  if (a.count() != 2) a.wrong_count();
  return plain(a, std::pow(a.number(0), a.number(1)));
}

Value whole_below(const Arguments& a) {
  if (a.count() != 1) a.wrong_count();
  return plain(a, std::floor(a.number(0)));
}

/// The remainder of a division, with the sign of the divisor: mod(-1, 4) is 3.
Value remainder(const Arguments& a) {
  if (a.count() != 2) a.wrong_count();
  const double x = a.number(0), y = a.number(1);
  if (y == 0) a.fail(1, "division by zero");
  return plain(a, x - y * std::floor(x / y));
}

/// A pseudorandom number in [0, 1), as a hash of the arguments: equal for equal arguments, uncorrelated otherwise. Their bits
/// are mixed one after the other by the finalizer of MurmurHash3 with the constants of D. Stafford's "Mix13" (2011).
Value random(const Arguments& a) {
  if (a.count() == 0) a.wrong_count();
  std::uint64_t state = 0x9E3779B97F4A7C15u;
  for (size_t i = 0; i < a.count(); ++i) {
    std::uint64_t x = std::bit_cast<std::uint64_t>(a.number(i) + 0.0) + state;  // -0 is 0
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    state = (x ^ (x >> 31)) + 0x9E3779B97F4A7C15u;
  }
  return Value(Number{double(state >> 11) * 0x1p-53});
}

/// Concatenates several lists.
Value join(const Arguments& a) {
  Value::List entries;
  for (size_t i = 0; i < a.count(); ++i) {
    if (!a.as<Numbers>(i) && !a.as<Value::List>(i)) a.wrong(i, "a list");
    if (entries.size() + list_size(a[i], a[i].location) > 1'000'000) a.fail(i, "join gives 1000000 entries at most");
    for (size_t k = 0; k < list_size(a[i], a[i].location); ++k) entries.push_back(list_entry(a[i], k));
  }
  return packed(std::move(entries), a.count() > 0 ? a[0].location : Location{});
}

constexpr Function functions[] = {
    {"sqrt", "sqrt(number)", square_root},
    {"sin", "sin(angle)", [](const Arguments& a) { return Value(Number{std::sin(angle(a))}); }},
    {"cos", "cos(angle)", [](const Arguments& a) { return Value(Number{std::cos(angle(a))}); }},
    {"tan", "tan(angle)", [](const Arguments& a) { return plain(a, std::tan(angle(a))); }},
    {"min", "min(number, number, …)", [](const Arguments& a) { return extreme(a, std::less<>()); }},
    {"max", "max(number, number, …)", [](const Arguments& a) { return extreme(a, std::greater<>()); }},
    {"abs", "abs(number)", absolute},
    {"pow", "pow(base, exponent)", power},
    {"floor", "floor(number)", whole_below},
    {"mod", "mod(number, divisor)", remainder},
    {"random", "random(number, …)", random},
    {"join", "join(list, …)", join},
    // Usually evaluated by Evaluator::count, without a copy of the list.
    {"count", "count(list)", [](const Arguments& a) { return Value(Number{double(list_size(a[0], a[0].location))}); }},
};

}  // namespace

std::span<const Function> math_functions() { return functions; }

}  // namespace etendue::language
