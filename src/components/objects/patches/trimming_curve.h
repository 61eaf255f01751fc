#pragma once
// TrimmingCurve: a curve in a surface's parameter space that bounds its trimmed region.

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// A rational B-spline in the parameter plane of a surface.
class TrimmingCurve final : public Component {
 public:
  using Interface = TrimmingCurve;
  using Parent = Component;
  static void describe(Description<TrimmingCurve>&);
  void prepare() override;

  /// Appends points along the curve, including both ends, such that the chords deviate from the curve by at most `tolerance`.
  void flatten(double tolerance, std::vector<std::array<double, 2>>& points) const;

  int degree = 1;
  std::vector<float> knots;
  std::vector<Point2> points{{0.2f, 0.2f}, {0.8f, 0.2f}, {0.5f, 0.8f}, {0.2f, 0.2f}};
  std::vector<float> weights;

 private:
  std::vector<float> knots_;  // the given knots, or uniform ones
};

}  // namespace etendue
