// Functions of numbers.

#include <cmath>

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

/// A plain number is refused: some would mean degrees by it, some radians.
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

constexpr Function functions[] = {
    {"sqrt", "sqrt(number)", square_root},
    {"sin", "sin(angle)", [](const Arguments& a) { return Value(Number{std::sin(angle(a))}); }},
    {"cos", "cos(angle)", [](const Arguments& a) { return Value(Number{std::cos(angle(a))}); }},
    {"tan", "tan(angle)", [](const Arguments& a) { return plain(a, std::tan(angle(a))); }},
    {"min", "min(number, number, …)", [](const Arguments& a) { return extreme(a, std::less<>()); }},
    {"max", "max(number, number, …)", [](const Arguments& a) { return extreme(a, std::greater<>()); }},
    {"abs", "abs(number)", absolute},
    {"pow", "pow(base, exponent)", power},
};

}  // namespace

std::span<const Function> math_functions() { return functions; }

}  // namespace etendue::language
