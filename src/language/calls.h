#pragma once
// The functions of the language.

#include <span>
#include <string>
#include <vector>

#include "etendue/core/vector.h"
#include "evaluator.h"

namespace etendue::language {

/// The arguments of one call. Arguments that do not match throw Error at their location, with the usage of the function.
class Arguments {
 public:
  Arguments(const std::vector<Value>& values, const char* usage, Location at, bool files_allowed)
      : values_(values), usage_(usage), at_(at), files_allowed_(files_allowed) {}

  size_t count() const { return values_.size(); }
  const Value& operator[](size_t i) const { return values_[i]; }
  template <class T>
  const T* as(size_t i) const {
    return i < values_.size() ? values_[i].as<T>() : nullptr;
  }
  /// Throws Error for a wrong number of arguments.
  [[noreturn]] void wrong_count() const;
  [[noreturn]] void wrong(size_t i, const std::string& expected) const;
  /// Throws Error with any message at an argument.
  [[noreturn]] void fail(size_t i, const std::string& message) const;

  /// Throws Error for a number outside of the allowed range, in the unit of the message.
  [[noreturn]] void out_of_range(size_t i, double x, double low, double high) const;
  /// Throws Error for a number that is too large for a float.
  [[noreturn]] void too_large(size_t i, double x) const;

  /// A plain number, or a number of this dimension, in base units. Throws Error if it is too large for a float.
  double number(size_t i, Dimension = Dimension::none) const;
  /// An angle [rad]; a plain number is in degrees.
  double angle(size_t i) const;
  const std::string& string(size_t i) const;
  /// A list of plain numbers, packed.
  const Numbers& numbers(size_t i) const;
  DoubleVector3 vector(size_t i, Dimension = Dimension::none) const;
  /// A vector as the only argument, or three numbers as three arguments.
  DoubleVector3 vector_or_three(Dimension = Dimension::none) const;
  bool files_allowed() const { return files_allowed_; }

 private:
  const std::vector<Value>& values_;
  const char* usage_;
  Location at_;
  bool files_allowed_;
};

struct Function {
  const char* name;
  const char* usage;  ///< "blackbody(temperature)", for messages
  Value (*call)(const Arguments&);
};

std::span<const Function> color_functions();
std::span<const Function> transform_functions();
std::span<const Function> math_functions();

}  // namespace etendue::language
