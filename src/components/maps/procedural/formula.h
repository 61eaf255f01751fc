#pragma once
// A formula as a program for a small stack machine.

#include <string>
#include <vector>

#include "etendue/core/error.h"
#include "etendue/core/spectrum.h"

namespace etendue {

/// A formula of numbers, names, + - * / and calls of functions. It is compiled once; running it allocates no memory. All values
/// are finite: a result that is not, such as that of a division by zero, is replaced by 0 immediately.
class Formula {
 public:
  Formula() = default;
  /// `names` are the names that may be used in the formula, in the order of `run`'s values. Throws Error with the location of
  /// the mistake: line 1 of a text named `text_name`, with columns counted from `first_column`.
  Formula(const std::string& text, const std::vector<std::string>& names, const char* text_name = "formula",
          int first_column = 1);

  /// Which of the names the formula uses.
  const std::vector<bool>& used() const { return used_; }
  /// `values` has one for each name.
  Spectrum run(const Spectrum* values) const;

  static std::vector<std::string> function_names();
  static constexpr int deepest = 32;  ///< values on the stack

  /// Operation codes of the steps. Functions are in the order of function_names, from `first_function` on.
  enum Code : std::uint8_t {
    push_number,
    push_value,
    add,
    subtract,
    multiply,
    divide,
    negate,
    first_function,
    absolute = first_function,
    square_root,
    exponential,
    logarithm,
    sine,
    cosine,
    tangent,
    arc_tangent_2,
    round_down,
    fraction,
    remainder,
    power,
    minimum,
    maximum,
    threshold,
    clamp,
    mix,
    smooth_step,
    mean,
    operation_count
  };

  struct Step {
    std::uint8_t operation;
    std::uint16_t place = 0;  ///< index of the name, for push_value
    float number = 0;
  };
  /// The program, for interpreters other than `run`, such as one for interval arithmetic.
  const std::vector<Step>& steps() const { return steps_; }
  /// How many values an operation takes off the stack.
  static int arguments(std::uint8_t operation);

 private:
  friend class FormulaCompiler;
  std::vector<Step> steps_{{0, 0, 0}};
  std::vector<bool> used_;
};

}  // namespace etendue
