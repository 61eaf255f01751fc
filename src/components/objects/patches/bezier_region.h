#pragma once
// Parts of Bézier patches: by grids of squares, each of them there, cut away, or there in part, as trapezoids.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue::bezier {

/// Where t0 <= t <= t1, between two edges that are straight from (left0, t0) to (left1, t1) and (right0, t0) to (right1, t1).
struct Trapezoid {
  double t0, t1, left0, left1, right0, right1;
  double area() const { return 0.5 * (t1 - t0) * (right0 - left0 + right1 - left1); }
  struct Place {
    double s, t;
  };
  /// A linear map of the unit square's rows to its rows; `stretch` is the derivative of s with x, and that of t is t1 - t0.
  Place at(double x, double y, double& stretch) const {
    const double left = left0 + y * (left1 - left0), right = right0 + y * (right1 - right0);
    stretch = right - left;
    return {left + x * stretch, t0 + y * (t1 - t0)};
  }
};

/// A segment of a closed loop in a patch's coordinates.
struct Segment {
  double s0, t0, s1, t1;
};

/// One for a number of patches, all with the same grid.
class Region {
 public:
  /// All is there.
  Region(std::size_t patches, int grid) : grid_(grid), whole_(patches, true) {}

  int grid() const { return grid_; }
  bool trimmed() const { return !squares_.empty(); }
  /// Leaves of a patch what closed loops wind around, or what they do not wind around.
  void trim(std::uint32_t patch, const std::vector<Segment>& loops, bool keep_inside);

  /// What is there of a square, by rows; `scratch` holds it when that is all.
  std::span<const Trapezoid> parts(std::uint32_t patch, int i, int j, Trapezoid& scratch) const;
  bool contains(std::uint32_t patch, double s, double t) const;
  /// Whether anything is there in a rectangle, judged by whole squares.
  bool touches(std::uint32_t patch, double s0, double s1, double t0, double t1) const;

 private:
  struct Square {
    std::uint32_t first = 0, count = 0;  // trapezoids
  };
  int index(double x) const { return std::min(int(std::max(x, 0.0) * grid_), grid_ - 1); }
  const Square& square(std::uint32_t patch, int i, int j) const {
    return squares_[std::size_t(patch * grid_ + j) * std::size_t(grid_) + std::size_t(i)];
  }
  void cut_square(const std::vector<Segment>& row, bool keep_inside, int i, int j);

  int grid_;
  std::vector<bool> whole_;      // of each patch: not trimmed
  std::vector<Square> squares_;  // of all patches, once one of them is trimmed
  std::vector<Trapezoid> parts_;
};

}  // namespace etendue::bezier
