#pragma once
// A formula of x, y and z as a field: its value, its gradient, and bounds of both.

#include "components/maps/procedural/formula.h"
#include "geometry/interval.h"
#include "implicit_object.h"

namespace etendue {

/// Runs a formula's program on other numbers: doubles, intervals, and either with derivatives (automatic differentiation).
/// Unlike in maps, `pow` with a whole number as exponent takes a negative base, too.
class FormulaField {
 public:
  FormulaField() = default;
  /// A formula of three names.
  explicit FormulaField(const Formula&);

  double value(const Place&) const;
  /// Not finite where there is none.
  Place gradient(const Place&) const;
  /// Bounds in a box.
  Interval range(const std::array<Interval, 3>& box) const;
  /// Bounds on a line through a box, and of the derivative along it; `direction` is the derivative of x, y and z.
  Interval range(const std::array<Interval, 3>& box, const double (&direction)[3], Interval& slope) const;

 private:
  static constexpr std::uint8_t raise = Formula::operation_count;
  struct Step {
    std::uint8_t operation;
    int place = 0;  // of x, y and z; the exponent
    double number = 0;
  };
  template <class T>
  T run(const std::array<T, 3>&) const;
  std::vector<Step> steps_;
};

}  // namespace etendue
