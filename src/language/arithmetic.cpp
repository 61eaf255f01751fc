// Arithmetic on values, and packing of lists of numbers.

#include <fmt/format.h>

#include <cmath>

#include "etendue/describe/color.h"
#include "evaluator.h"

namespace etendue::language {

namespace {

[[noreturn]] void meaningless(const char* verb, const char* preposition, const Value& a, const Value& b, Location at) {
  throw Error(fmt::format("cannot {} {} {} {}", verb, a.kind(), preposition, b.kind()), at);
}

std::string words(Dimension d) { return d == Dimension::none ? "a plain number" : with_article(name(d)); }

double finite(double x, Location at) {
  if (!std::isfinite(x)) throw Error("the result is too large for a number", at);
  return x;
}

Dimension common(Dimension a, Dimension b, const char* verb, const char* preposition, Location at) {
  if (a != b) throw Error(fmt::format("cannot {} {} {} {}", verb, words(a), preposition, words(b)), at);
  return a;
}

/// a + sign b.
Value sum(const Value& a, const Value& b, double sign, Location at) {
  const char* verb = sign > 0 ? "add" : "combine";
  const char* preposition = sign > 0 ? "to" : "by '-' with";
  const auto *x = a.as<Number>(), *y = b.as<Number>();
  if (x && y)
    return Value(Number{finite(x->value + sign * y->value, at), common(x->dimension, y->dimension, verb, preposition, at)},
                 a.location);
  const auto *u = a.as<Numbers>(), *v = b.as<Numbers>();
  const auto is_list = [](const Value& value) { return value.as<Value::List>() || value.as<Numbers>(); };
  if (sign > 0 && is_list(a) && is_list(b) && (a.as<Value::List>() || b.as<Value::List>()))
    throw Error(fmt::format("cannot add {} to {}: one list of the entries of both is join(a, b)", a.kind(), b.kind()), at);
  if (!u || !v || u->width != v->width || u->values.size() != v->values.size()) meaningless(verb, preposition, a, b, at);
  Numbers result = *u;
  common(u->dimension, v->dimension, verb, preposition, at);
  for (size_t i = 0; i < result.values.size(); ++i) result.values[i] = finite(result.values[i] + sign * v->values[i], at);
  return Value(std::move(result), a.location);
}

/// Multiplies each number by a factor; the result takes the factor's dimension if it has one.
Value scaled(const Numbers& numbers, const Number& factor, Location at) {
  Numbers result = numbers;
  for (double& x : result.values) x = finite(x * factor.value, at);
  if (factor.dimension != Dimension::none) result.dimension = factor.dimension;
  return Value(std::move(result));
}

Dimension product(Dimension a, Dimension b, Location at) {
  if (a != Dimension::none && b != Dimension::none)
    throw Error(fmt::format("cannot multiply {} by {}: one of them must be a plain number", words(a), words(b)), at);
  return a != Dimension::none ? a : b;
}

Dimension quotient(Dimension a, Dimension b, Location at) {
  if (b == Dimension::none) return a;
  if (a != b) throw Error(fmt::format("cannot divide {} by {}", words(a), words(b)), at);
  return Dimension::none;
}

}  // namespace

Value add(const Value& a, const Value& b, Location at) { return sum(a, b, 1, at); }

Value subtract(const Value& a, const Value& b, Location at) { return sum(a, b, -1, at); }

Value multiply(const Value& a, const Value& b, Location at) {
  const auto *x = a.as<Number>(), *y = b.as<Number>();
  if (x && y) return Value(Number{finite(x->value * y->value, at), product(x->dimension, y->dimension, at)});
  if (const auto *s = a.as<Transform>(), *t = b.as<Transform>(); s && t) return Value(*s * *t);
  const Number* factor = x ? x : y;
  const Value& other = x ? b : a;
  if (!factor) meaningless("multiply", "by", a, b, at);
  if (const auto* numbers = other.as<Numbers>()) {
    product(factor->dimension, numbers->dimension, at);
    return scaled(*numbers, *factor, at);
  }
  const auto* color = other.as<Color>();
  if (!color || factor->dimension != Dimension::none) meaningless("multiply", "by", a, b, at);
  return Value(scaled_spectrum(factor->value, *color));
}

Value divide(const Value& a, const Value& b, Location at) {
  const auto* y = b.as<Number>();
  if (!y) meaningless("divide", "by", a, b, at);
  if (y->value == 0) throw Error("division by zero", at);
  if (const auto* x = a.as<Number>())
    return Value(Number{finite(x->value / y->value, at), quotient(x->dimension, y->dimension, at)});
  if (const auto* numbers = a.as<Numbers>()) {
    Numbers result = *numbers;
    result.dimension = quotient(numbers->dimension, y->dimension, at);
    for (double& x : result.values) x = finite(x / y->value, at);
    return Value(std::move(result));
  }
  const auto* color = a.as<Color>();
  if (!color || y->dimension != Dimension::none) meaningless("divide", "by", a, b, at);
  return Value(scaled_spectrum(finite(1 / y->value, at), *color));
}

Value power(const Value& base, const Value& exponent, Location at) {
  const auto *x = base.as<Number>(), *y = exponent.as<Number>();
  if (!x || !y) throw Error(fmt::format("cannot raise {} to the power of {}", base.kind(), exponent.kind()), at);
  if (x->dimension != Dimension::none || y->dimension != Dimension::none)
    throw Error(
        fmt::format("cannot raise {} to the power of {}: both must be plain numbers", words(x->dimension), words(y->dimension)),
        at);
  const double result = std::pow(x->value, y->value);
  if (!std::isfinite(result))
    throw Error(fmt::format("{:.9g} to the power of {:.9g} is not a finite number", x->value, y->value), at);
  return Value(Number{result});
}

Value negate(const Value& a, Location at) {
  if (const auto* x = a.as<Number>()) return Value(Number{-x->value, x->dimension}, at);
  const auto* numbers = a.as<Numbers>();
  if (!numbers) throw Error(fmt::format("cannot negate {}", a.kind()), at);
  Value result = scaled(*numbers, {-1}, at);
  result.location = at;
  return result;
}

Value with_unit(Value value, const Unit& unit, Location at) {
  const auto plain = [&](Dimension d) {
    if (d != Dimension::none) throw Error(fmt::format("cannot give {} a second unit", words(d)), at);
  };
  if (auto* number = std::get_if<Number>(&value.data)) {
    plain(number->dimension);
    *number = {finite(number->value * unit.factor, at), unit.dimension};
  } else if (auto* numbers = std::get_if<Numbers>(&value.data)) {
    plain(numbers->dimension);
    for (double& x : numbers->values) x = finite(x * unit.factor, at);
    numbers->dimension = unit.dimension;
  } else {
    throw Error(fmt::format("only numbers have units, not {}", value.kind()), at);
  }
  return value;
}

namespace {

/// Collects the common dimension of a list. Zeros take the dimension of the other entries, since 0 is the same in all units.
struct Merged {
  Dimension dimension = Dimension::none;
  bool plain = false;  // whether there is a plain number other than zero

  void add(Dimension d, bool zero, Location at) {
    if (d == Dimension::none) {
      plain = plain || !zero;
    } else if (dimension != Dimension::none && d != dimension) {
      throw Error(fmt::format("a list cannot mix {} and {}", words(dimension), words(d)), at);
    } else {
      dimension = d;
    }
    if (plain && dimension != Dimension::none)
      throw Error(fmt::format("a list cannot mix a plain number and {}: give each its unit", words(dimension)), at);
  }
};

bool all_zero(const std::vector<double>& values) {
  for (const double x : values)
    if (x != 0) return false;
  return true;
}

}  // namespace

Value packed(Value::List items, Location at) {
  size_t numbers = 0, rows = 0;
  const auto* first_row = items.empty() ? nullptr : items.front().as<Numbers>();
  for (const Value& item : items) {
    if (item.as<Number>()) ++numbers;
    const auto* row = item.as<Numbers>();
    if (row && row->width == 1 && row->values.size() >= 2 && row->values.size() <= 4 && first_row &&
        row->values.size() == first_row->values.size())
      ++rows;
  }
  if (items.empty() || (numbers != items.size() && rows != items.size())) return Value(std::move(items), at);
  Numbers result;
  Merged merged;
  if (rows != 0) result.width = int(first_row->values.size());
  result.values.reserve(items.size() * size_t(result.width));
  for (const Value& item : items) {
    if (const auto* number = item.as<Number>()) {
      merged.add(number->dimension, number->value == 0, item.location);
      result.values.push_back(number->value);
    } else {
      const auto* row = item.as<Numbers>();
      merged.add(row->dimension, all_zero(row->values), item.location);
      result.values.insert(result.values.end(), row->values.begin(), row->values.end());
    }
  }
  result.dimension = merged.dimension;
  return Value(std::move(result), at);
}

}  // namespace etendue::language
