#pragma once
// Areas of Bézier patches, and points on them by area.

#include "bezier_patch.h"
#include "bezier_region.h"
#include "etendue/core/vector.h"

namespace etendue::bezier {

/// Points are uniform in (s, t) within each square of a patch's grid, and the squares are chosen by their area: the density
/// by area is exact for the curved surface, and varies within a square as |S_s x S_t| does.
class AreaTable {
 public:
  AreaTable() = default;
  AreaTable(const std::vector<Patch>&, const Region&);

  double area() const { return area_; }
  /// Bound of its relative error, by the difference of two quadratures.
  double area_error() const { return error_; }

  struct Choice {
    std::uint32_t patch = 0;
    float s = 0, t = 0;
  };
  Choice choose(Point2 u, const Region&) const;
  /// The density of a choice per unit of s and t.
  double pdf(std::uint32_t patch, float s, float t) const;

 private:
  /// Finds the interval of x * (the last sum) among growing sums; x becomes the place within it, from 0 to 1.
  static std::size_t find(const double* sums, std::size_t count, double& x);

  int grid_ = 1;
  double area_ = 0, error_ = 0;
  std::vector<double> patches_;  // sums of areas up to each patch
  std::vector<double> rows_;     // within a patch, up to each row
  std::vector<double> squares_;  // within a row, up to each square
  std::vector<double> pdfs_;     // of each square
};

}  // namespace etendue::bezier
