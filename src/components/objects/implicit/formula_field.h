#pragma once
// FormulaField: a formula of x, y and z as a scalar field, with its value, its gradient and bounds of both.

#include "components/maps/procedural/formula.h"
#include "geometry/interval.h"
#include "implicit_object.h"

namespace etendue {

/// Evaluates a formula's program on other number types: doubles, intervals, and dual numbers of either (automatic
/// differentiation). Unlike in maps, `pow` with an integer exponent accepts a negative base.
class FormulaField {
 public:
  FormulaField() = default;
  /// From a formula of the three variables x, y and z.
  explicit FormulaField(const Formula&);

  double value(const Place&) const;
  /// Not finite where the gradient does not exist.
  Place gradient(const Place&) const;
  /// Bounds of the value in a box.
  Interval range(const std::array<Interval, 3>& box) const;
  /// Bounds of the value and of its derivative `slope` along a line within a box; `direction` is the derivative of (x, y, z)
  /// along the line.
  Interval range(const std::array<Interval, 3>& box, const double (&direction)[3], Interval& slope) const;

 private:
  static constexpr std::uint8_t raise = Formula::operation_count;
  struct Step {
    std::uint8_t operation;
    int place = 0;  // index of x, y or z; or the exponent
    double number = 0;
  };
  template <class T>
  T run(const std::array<T, 3>&) const;
  std::vector<Step> steps_;
};

}  // namespace etendue
