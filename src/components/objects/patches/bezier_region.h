#pragma once
// Trimmed regions of Bézier patches: a grid of squares per patch, each of which is kept, removed, or kept in part as
// trapezoids.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue::bezier {

/// The trapezoid t0 <= t <= t1 between the straight edges from (left0, t0) to (left1, t1) and from (right0, t0) to (right1,
/// t1).
struct Trapezoid {
  double t0, t1, left0, left1, right0, right1;
  double area() const { return 0.5 * (t1 - t0) * (right0 - left0 + right1 - left1); }
  struct Place {
    double s, t;
  };
  /// Maps the unit square to the trapezoid, linearly in each row; `stretch` is ds/dx, and dt/dy is t1 - t0.
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

/// The kept regions of a number of patches, all with the same grid resolution.
class Region {
 public:
  /// Keeps all patches completely.
  Region(std::size_t patches, int grid) : grid_(grid), whole_(patches, true) {}

  int grid() const { return grid_; }
  bool trimmed() const { return !squares_.empty(); }
  /// Keeps of a patch the part with a winding number other than 0 with respect to closed loops, or the rest.
  void trim(std::uint32_t patch, const std::vector<Segment>& loops, bool keep_inside);

  /// The kept trapezoids of a square, in order of t; `scratch` stores the square if all of it is kept.
  std::span<const Trapezoid> parts(std::uint32_t patch, int i, int j, Trapezoid& scratch) const;
  bool contains(std::uint32_t patch, double s, double t) const;
  /// Whether any part of a rectangle is kept; conservative, since whole squares are tested.
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
  std::vector<bool> whole_;      // for each patch: whether it is not trimmed
  std::vector<Square> squares_;  // of all patches; empty as long as none is trimmed
  std::vector<Trapezoid> parts_;
};

}  // namespace etendue::bezier
