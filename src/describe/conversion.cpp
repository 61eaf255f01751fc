// Conversion between values of the language and the C++ types of members. Types, units and ranges are checked only here.

#include <fmt/format.h>

#include <algorithm>

#include "etendue/describe/color.h"
#include "etendue/describe/description.h"
#include "words.h"

namespace etendue::detail {

namespace {

[[noreturn]] void mismatch(const std::string& wanted, const Value& v) {
  throw Error("expects " + wanted + ", not " + v.kind(), v.location);
}

/// Converts a number from base units to the member's unit.
double in_member_unit(double value, Dimension dimension, const Member& m, Location at) {
  if (dimension == Dimension::none) return value;
  const Unit* unit = find_unit(m.unit);
  if (!unit)
    throw Error(fmt::format("expects a plain number{}, not {}", m.unit == "1" || m.unit.empty() ? "" : " in " + m.unit,
                            with_article(name(dimension))),
                at);
  if (unit->dimension != dimension)
    throw Error(
        fmt::format("expects {} [{}], not {}", with_article(name(unit->dimension)), m.unit, with_article(name(dimension))), at);
  return value / unit->factor;
}

void check_range(double x, const Member& m, Location at) {
  if (!std::isfinite(x)) throw Error("must be a finite number", at);
  if (m.range && std::isfinite(m.range->high) && !m.range->contains(x)) {
    // The error about the member's range, below, is more specific than that about the range of floats.
  } else if (std::abs(x) > double(std::numeric_limits<float>::max())) {
    throw Error(fmt::format("must be at most {:.6g} in magnitude, not {:.9g}", double(std::numeric_limits<float>::max()), x),
                at);
  }
  if (m.range && m.range->open_low && x > m.range->low && !(float(x) > float(m.range->low)))
    throw Error(fmt::format("must be {}, and {:.9g} is {:.9g} in single precision", m.range->text(), x, float(x)), at);
  if (m.range && !m.range->contains(x)) {
    const std::string unit = m.unit == "1" || m.unit.empty() ? "" : " " + m.unit;
    throw Error(fmt::format("must be {}{}, not {:.9g}{}", m.range->text(), unit, x, unit), at);
  }
}

double checked(double value, Dimension dimension, const Member& m, Location at) {
  const double x = in_member_unit(value, dimension, m, at);
  check_range(x, m, at);
  // A range's ends are compared as floats, too, which large integers need not be.
  if (m.kind == Kind::integer && m.range && (x < m.range->low || x > m.range->high))
    throw Error(fmt::format("must be {}, not {:.17g}", m.range->text(), x), at);
  return x;
}

double unit_factor(const Member& m, Dimension& dimension) {
  const Unit* unit = find_unit(m.unit);
  dimension = unit ? unit->dimension : Dimension::none;
  return unit ? unit->factor : 1;
}

/// The function by which a text such as "#ff8000", "paint.csv", "Au", "D65" or "N-BK7" becomes a colour; "" for other texts.
std::string color_call(const std::string& text) {
  if (text.starts_with("#")) return "srgb";
  for (const char* ending : {".csv", ".spd", ".txt"})
    if (text.ends_with(ending)) return "spectrum";
  const auto known = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), text) != names.end();
  };
  if (known(metal_names())) return "metal";
  if (known(illuminant_names())) return "illuminant";
  return known(glass_names()) ? "glass" : "";
}

}  // namespace

bool to_bool(const Value& v) {
  if (const bool* b = v.as<bool>()) return *b;
  mismatch("true or false", v);
}

double to_number(const Value& v, const Member& m) {
  if (const auto* n = v.as<Number>()) return checked(n->value, n->dimension, m, v.location);
  mismatch("a number", v);
}

std::int64_t to_integer(const Value& v, const Member& m, std::int64_t low, std::int64_t high) {
  const auto* n = v.as<Number>();
  if (!n) mismatch("a whole number", v);
  const double x = checked(n->value, n->dimension, m, v.location);
  if (x != std::floor(x)) throw Error(fmt::format("expects a whole number, not {:.9g}", x), v.location);
  if (x < double(low) || x > double(high))
    throw Error(fmt::format("must be from {} to {}, not {:.17g}", low, high, x), v.location);
  // The language's numbers are doubles: an integer next to 2^53 may have been rounded to 2^53.
  if (std::abs(x) >= 0x1p53) throw Error(fmt::format("must be less than 2^53 = {:.0f}", 0x1p53), v.location);
  return std::int64_t(x);
}

std::string to_string(const Value& v, const Member& m) {
  const auto* s = v.as<std::string>();
  if (!s) mismatch("a string", v);
  const auto goes_on = [&](const std::string& choice) {
    const std::string begin = beginning_of_choice(choice);
    return !begin.empty() && s->starts_with(begin);
  };
  if (!m.choices.empty() && std::ranges::none_of(m.choices, goes_on)) static_cast<void>(to_choice(v, m));
  return *s;
}

FilePath to_file(const Value& v) {
  if (const auto* f = v.as<FilePath>()) return *f;
  if (const auto* s = v.as<std::string>()) return {*s, v.folder};
  mismatch("a file name in quotes", v);
}

int to_choice(const Value& v, const Member& m) {
  std::string known;
  for (const std::string& c : m.choices) known += (known.empty() ? "" : ", ") + c;
  const std::string none = "none";  // a choice, written like the keyword
  const std::string* s = v.none() ? &none : v.as<std::string>();
  if (!s) mismatch("one of " + known, v);
  for (size_t i = 0; i < m.choices.size(); ++i)
    if (m.choices[i] == *s) return int(i);
  throw Error(fmt::format("has no choice '{}'{}; known are {}", *s, meant_choice(*s, m), known), v.location);
}

void to_numbers(const Value& v, const Member& m, double* out, int count) {
  const auto* n = v.as<Numbers>();
  if (!n || n->width != 1 || n->values.size() != size_t(count)) mismatch(fmt::format("{} numbers in brackets", count), v);
  for (int i = 0; i < count; ++i) out[i] = checked(n->values[size_t(i)], n->dimension, m, v.location);
}

Color to_color(const Value& v, const Member& m) {
  if (const auto* c = v.as<Color>()) return *c;
  if (const auto* n = v.as<Number>()) return flat_spectrum(float(checked(n->value, n->dimension, m, v.location)));
  if (v.none()) return nullptr;
  const auto* text = v.as<std::string>();
  const std::string call = text ? color_call(*text) : std::string();
  if (!call.empty())
    throw Error(fmt::format("expects a colour or spectrum, not a string: write {}(\"{}\")", call, *text), v.location);
  const auto* numbers = v.as<Numbers>();
  if (numbers && numbers->width == 1 && numbers->values.size() == 3 && numbers->dimension == Dimension::none)
    throw Error(fmt::format("expects a colour or spectrum, not {}: write rgb({}, {}, {})", v.kind(), numbers->values[0],
                            numbers->values[1], numbers->values[2]),
                v.location);
  mismatch("a colour or spectrum", v);
}

AnimatedTransform to_transform(const Value& v) {
  AnimatedTransform t;
  if (const auto* still = v.as<Transform>())
    t = *still;
  else if (const auto* moving = v.as<AnimatedTransform>())
    t = *moving;
  else
    mismatch("a transform", v);
  if (!t.valid()) throw Error("is a singular transform: it has no inverse", v.location);
  return t;
}

Ref<Component> to_component(const Value& v, const Member& m) {
  Registry& registry = Registry::instance();
  const ClassInfo* wanted = registry.find(m.component_class);
  if (!wanted) throw Error("refers to the unknown class " + m.component_class, v.location);
  if (v.none()) return nullptr;
  if (const auto* c = v.as<Ref<Component>>()) {
    if (!*c || (*c)->class_info().is_a(*wanted)) return *c;
    throw Error(fmt::format("expects {}, not {}", with_article(wanted->name), with_article((*c)->class_info().name)),
                v.location);
  }
  for (const ClassInfo* candidate : registry.subclasses(*wanted)) {
    if (candidate->literal.empty()) continue;
    Ref<Component> made = registry.create(candidate->name);
    const Member& literal = *candidate->find(candidate->literal);
    // A length for a map of numbers is converted to the member's unit: a map of thicknesses in nm may be 0.4 um everywhere.
    if (const auto* n = v.as<Number>(); n && n->dimension != Dimension::none)
      literal.store(*made, literal, Value(Number{in_member_unit(n->value, n->dimension, m, v.location)}, v.location));
    else
      literal.store(*made, literal, v);
    return made;
  }
  if (v.as<Value::List>() && m.list)
    throw Error(fmt::format("expects {}, not {}: one list of the entries of several is join(a, b)", with_article(wanted->name),
                            v.kind()),
                v.location);
  mismatch(with_article(wanted->name), v);
}

void to_rows(const Value& v, const Member& m, int width, void (*push)(void*, const double*), void* to,
             void (*reserve)(void*, size_t)) {
  if (const auto* list = v.as<Value::List>(); list && list->empty()) return;
  const auto* n = v.as<Numbers>();
  const std::string wanted = width == 1 ? "a list of numbers" : fmt::format("a list of rows of {} numbers", width);
  if (!n || (n->width != width && n->width != 1)) mismatch(wanted, v);
  if (n->values.size() % size_t(width) != 0) {
    throw Error(fmt::format("expects {}; {} numbers are not a multiple of {}", wanted, n->values.size(), width), v.location);
  }
  const size_t rows = n->values.size() / size_t(width);
  reserve(to, rows);
  double row[4];
  for (size_t r = 0; r < rows; ++r) {
    for (int k = 0; k < width; ++k) {
      const double x = n->values[r * size_t(width) + size_t(k)];
      try {
        row[k] = checked(x, n->dimension, m, v.location);
      } catch (const Error& e) {
        throw Error(fmt::format("entry {}: {}", r, e.what()), v.location);
      }
    }
    push(to, row);
  }
}

void to_integers(const Value& v, const Member& m, std::int64_t low, std::int64_t high, void (*push)(void*, std::int64_t),
                 void* to, void (*reserve)(void*, size_t)) {
  if (const auto* list = v.as<Value::List>(); list && list->empty()) return;
  const auto* n = v.as<Numbers>();
  if (!n || n->dimension != Dimension::none || (n->width != 1 && n->width != 3)) mismatch("a list of whole numbers", v);
  reserve(to, n->values.size());
  for (size_t i = 0; i < n->values.size(); ++i) {
    const double x = n->values[i];
    if (x != std::floor(x)) throw Error(fmt::format("entry {} is {:.9g}, not a whole number", i, x), v.location);
    if (x < double(low) || x > double(high))
      throw Error(fmt::format("entry {} is {:.17g}, not from {} to {}", i, x, low, high), v.location);
    if (m.range && !m.range->contains(x)) throw Error(fmt::format("entry {} is {}, not {}", i, x, m.range->text()), v.location);
    push(to, std::int64_t(x));
  }
}

const Value::List& to_list(const Value& v, Value::List& scratch) {
  if (const auto* list = v.as<Value::List>()) return *list;
  if (const auto* n = v.as<Numbers>()) {  // plain numbers where components are expected
    for (size_t r = 0; r < n->rows(); ++r) {
      if (n->width == 1)
        scratch.emplace_back(Number{n->values[r], n->dimension}, v.location);
      else
        scratch.emplace_back(
            Numbers{{n->values.begin() + long(r) * n->width, n->values.begin() + long(r + 1) * n->width}, 1, n->dimension},
            v.location);
    }
    return scratch;
  }
  if (const auto* c = v.as<Ref<Component>>(); c && *c)
    throw Error(fmt::format("expects a list, even of one: write [ {} {{ … }} ]", (*c)->class_info().name), v.location);
  mismatch("a list", v);
}

Value from_number(double x, const Member& m) {
  Number n;
  n.value = x * unit_factor(m, n.dimension);
  return Value(n);
}

Value from_numbers(const double* f, int count, const Member& m) {
  Numbers n;
  const double factor = unit_factor(m, n.dimension);
  for (int i = 0; i < count; ++i) n.values.push_back(f[i] * factor);
  return Value(std::move(n));
}

}  // namespace etendue::detail
