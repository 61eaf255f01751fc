#pragma once
// AreaTable: areas of Bézier patches, and area sampling of points on them.

#include "bezier_patch.h"
#include "bezier_region.h"
#include "etendue/core/vector.h"

namespace etendue::bezier {

/// Squares of a patch's grid are chosen in proportion to their area, and points are uniform in (s, t) within a square. The pdf
/// by area is known exactly; within a square it is proportional to 1 / |S_s x S_t|.
class AreaTable {
 public:
  AreaTable() = default;
  AreaTable(const std::vector<Patch>&, const Region&);

  double area() const { return area_; }
  /// Relative error of the area, estimated by the difference of two quadratures.
  double area_error() const { return error_; }

  struct Choice {
    std::uint32_t patch = 0;
    float s = 0, t = 0;
  };
  Choice choose(Point2 u, const Region&) const;
  /// The pdf of a choice per unit of s and t.
  double pdf(std::uint32_t patch, float s, float t) const;

 private:
  /// Finds the interval of the cumulative sums that contains x * (the last sum); x is set to the relative position in the
  /// interval, in [0, 1].
  static std::size_t find(const double* sums, std::size_t count, double& x);

  int grid_ = 1;
  double area_ = 0, error_ = 0;
  std::vector<double> patches_;  // cumulative areas of the patches
  std::vector<double> rows_;     // cumulative areas of the rows within a patch
  std::vector<double> squares_;  // cumulative areas of the squares within a row
  std::vector<double> pdfs_;     // for each square
};

}  // namespace etendue::bezier
