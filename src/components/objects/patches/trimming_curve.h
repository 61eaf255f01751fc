#pragma once
// Curves in a surface's parameters that cut parts of it away.

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// A rational spline in the plane of a surface's parameters.
class TrimmingCurve final : public Component {
 public:
  using Interface = TrimmingCurve;
  using Parent = Component;
  static void describe(Description<TrimmingCurve>&);
  void prepare() override;

  /// Appends points along the curve, its beginning and its end too, such that chords are off by at most `tolerance`.
  void flatten(double tolerance, std::vector<std::array<double, 2>>& points) const;

  int degree = 1;
  std::vector<float> knots;
  std::vector<Point2> points{{0.2f, 0.2f}, {0.8f, 0.2f}, {0.5f, 0.8f}, {0.2f, 0.2f}};
  std::vector<float> weights;

 private:
  std::vector<float> knots_;  // those given, or even ones
};

}  // namespace etendue
