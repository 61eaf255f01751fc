#include "calls.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "describe/words.h"

namespace etendue::language {

void Arguments::wrong_count() const {
  // The error points at the call: for functions with several forms it is not clear which argument is superfluous.
  throw Error(fmt::format("expects {}; {} given", usage_,
                          values_.size() == 1 ? "1 argument was" : fmt::format("{} arguments were", values_.size())),
              at_);
}

void Arguments::wrong(size_t i, const std::string& expected) const {
  if (i >= values_.size()) wrong_count();
  throw Error(fmt::format("expects {}: argument {} must be {}, not {}", usage_, i + 1, expected, values_[i].kind()),
              values_[i].location);
}

void Arguments::fail(size_t i, const std::string& message) const {
  throw Error(message, i < values_.size() ? values_[i].location : at_);
}

void Arguments::too_large(size_t i, double x) const {
  constexpr double most = double(std::numeric_limits<float>::max());
  out_of_range(i, x, -most, most);
}

void Arguments::out_of_range(size_t i, double x, double low, double high) const {
  fail(i, fmt::format("{}: argument {} must be from {:.6g} to {:.6g}, not {:.9g}", usage_, i + 1, low, high, x));
}

double Arguments::number(size_t i, Dimension dimension) const {
  const auto* n = as<Number>(i);
  const std::string expected = dimension == Dimension::none ? "a plain number" : "a " + std::string(name(dimension));
  if (!n || (n->dimension != Dimension::none && n->dimension != dimension)) wrong(i, expected);
  if (std::abs(n->value) > double(std::numeric_limits<float>::max())) too_large(i, n->value);
  return n->value;
}

double Arguments::angle(size_t i) const {
  const auto* n = as<Number>(i);
  if (!n || (n->dimension != Dimension::none && n->dimension != Dimension::angle)) wrong(i, "an angle");
  return n->dimension == Dimension::angle ? n->value : n->value * find_unit("deg")->factor;
}

const std::string& Arguments::string(size_t i) const {
  const auto* s = as<std::string>(i);
  if (!s) wrong(i, "a string");
  return *s;
}

const Numbers& Arguments::numbers(size_t i) const {
  const auto* n = as<Numbers>(i);
  if (!n || n->width != 1) wrong(i, "a list of numbers");
  return *n;
}

DoubleVector3 Arguments::vector(size_t i, Dimension dimension) const {
  const auto* n = as<Numbers>(i);
  const std::string expected =
      dimension == Dimension::none ? "3 plain numbers in brackets" : fmt::format("3 numbers [{}] in brackets", name(dimension));
  if (!n || n->width != 1 || n->values.size() != 3 || (n->dimension != Dimension::none && n->dimension != dimension))
    wrong(i, expected);
  for (const double x : n->values)
    if (std::abs(x) > double(std::numeric_limits<float>::max())) too_large(i, x);
  return {n->values[0], n->values[1], n->values[2]};
}

DoubleVector3 Arguments::vector_or_three(Dimension dimension) const {
  if (count() == 1) return vector(0, dimension);
  if (count() != 3) wrong_count();
  return {number(0, dimension), number(1, dimension), number(2, dimension)};
}

namespace {

const Function* find_function(const std::string& name) {
  for (const auto& functions : {color_functions(), transform_functions(), math_functions()})
    for (const Function& f : functions)
      if (name == f.name) return &f;
  return nullptr;
}

}  // namespace

bool is_function(const std::string& name) { return find_function(name) != nullptr; }

Value call(const std::string& function, const std::vector<Value>& values, Location at, bool allow_files) {
  if (const Function* f = find_function(function)) return f->call(Arguments(values, f->usage, at, allow_files));
  if (Registry::instance().find(function)) throw Error(fmt::format("'{0}' is a class: write {0} {{ … }}", function), at);
  std::vector<std::string> known;
  for (const auto& functions : {color_functions(), transform_functions(), math_functions()})
    for (const Function& f : functions) known.emplace_back(f.name);
  std::string meant = translation(function, foreign_functions());
  if (meant.empty()) meant = suggestion(function, known);
  if (meant.empty() && !(meant = translation(function, foreign_classes())).empty()) meant += ", which is a class";
  throw Error(fmt::format("there is no function '{}'{}", function, meant), at);
}

}  // namespace etendue::language
