#pragma once
// A formula as a program for a small stack machine.

#include <string>
#include <vector>

#include "etendue/core/error.h"
#include "etendue/core/spectrum.h"

namespace etendue {

/// A formula in numbers, names, + - * / and calls of functions. It is read once; running it allocates nothing, and gives
/// finite values only: what is none, such as a division by zero, becomes 0 where it arises.
class Formula {
 public:
  Formula() = default;
  /// `names` are what may stand in the formula, in the order of `run`'s values. What is wrong throws Error at its place: in
  /// line 1 of a text of this name, counting columns from `first_column` on.
  Formula(const std::string& text, const std::vector<std::string>& names, const char* text_name = "formula",
          int first_column = 1);

  /// Which of the names the formula uses.
  const std::vector<bool>& used() const { return used_; }
  /// `values` has one for each name.
  Spectrum run(const Spectrum* values) const;

  static std::vector<std::string> function_names();
  static constexpr int deepest = 32;  ///< values on the stack

  /// What a step does: functions are in the order of function_names, from `first_function` on.
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
    std::uint16_t place = 0;  ///< of a name
    float number = 0;
  };
  /// The program, for other machines than `run`: of intervals, say.
  const std::vector<Step>& steps() const { return steps_; }
  /// How many values an operation takes off the stack.
  static int arguments(std::uint8_t operation);

 private:
  friend class FormulaCompiler;
  std::vector<Step> steps_{{0, 0, 0}};
  std::vector<bool> used_;
};

}  // namespace etendue
