#pragma once
// A surface z = h(x, y) over a grid, bilinear in each cell.

#include <utility>
#include <vector>

#include "geometry/placed_object.h"

namespace etendue {

/// Heights [m] at the corners of cells. Places are told in cells: cell (i, j) is [i, i + 1] x [j, j + 1].
class HeightfieldGrid {
 public:
  HeightfieldGrid() = default;
  /// Heights row by row, `nx` to a row; at least two each way.
  HeightfieldGrid(std::vector<float> heights, int nx, int ny);

  int cells_x() const { return nx_ - 1; }
  int cells_y() const { return ny_ - 1; }
  double at(int i, int j) const { return double(heights_[size_t(j) * size_t(nx_) + size_t(i)]); }
  std::pair<float, float> range() const { return whole_; }

  /// The surface over a cell: h00 + a u + b v + c u v.
  struct Cell {
    double h00, a, b, c;
    double height(double u, double v) const { return h00 + a * u + (b + c * u) * v; }
    double slope_u(double v) const { return a + c * v; }
    double slope_v(double u) const { return b + c * u; }
  };
  Cell cell(int i, int j) const {
    const double h00 = at(i, j), h10 = at(i + 1, j), h01 = at(i, j + 1), h11 = at(i + 1, j + 1);
    return {h00, h10 - h00, h01 - h00, h11 - h10 - h01 + h00};
  }
  /// Slopes per cell at a corner, by central differences; at borders one-sided.
  std::pair<double, double> corner_slopes(int i, int j) const;

  /// Where a ray, given in cells and metres, first meets the surface.
  struct Found {
    int i, j;
    double u, v;
    float t;
  };
  /// With t in (0, maximum) as a float.
  bool nearest(const double (&origin)[3], const double (&direction)[3], float maximum, Found&) const;

 private:
  struct Range {
    float low, high;
  };
  struct Level {
    int nx, ny;
    std::vector<Range> ranges;
  };
  /// Lowest and highest point over a square of 2^level cells.
  Range range_of(int level, int i, int j) const;

  std::vector<float> heights_;
  int nx_ = 0, ny_ = 0;
  std::vector<Level> levels_;  // from squares of two cells up to one that holds them all; of one cell, none are kept
  std::pair<float, float> whole_{0, 0};
};

}  // namespace etendue
