#pragma once
// HeightfieldGrid: a surface z = h(x, y) over a regular grid, bilinear in each cell.

#include <utility>
#include <vector>

#include "etendue/placed_object.h"

namespace etendue {

/// Heights [m] at the corners of cells. x and y are in units of cells: cell (i, j) is [i, i + 1] x [j, j + 1].
class HeightfieldGrid {
 public:
  HeightfieldGrid() = default;
  /// Heights row by row, `nx` in a row; at least two rows and two columns.
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
  /// Slopes [m per cell] at a corner, by central differences, one-sided at borders.
  std::pair<double, double> corner_slopes(int i, int j) const;

  /// A ray's first hit on the surface: cell, position in the cell and t.
  struct Found {
    int i, j;
    double u, v;
    float t;
  };
  /// The nearest hit with the float t in (0, maximum) of a ray whose x and y are in cells and whose z is in metres.
  bool nearest(const double (&origin)[3], const double (&direction)[3], float maximum, Found&) const;

 private:
  struct Range {
    float low, high;
  };
  struct Level {
    int nx, ny;
    std::vector<Range> ranges;
  };
  /// Lowest and highest height over a square of 2^level x 2^level cells.
  Range range_of(int level, int i, int j) const;

  std::vector<float> heights_;
  int nx_ = 0, ny_ = 0;
  std::vector<Level> levels_;  // from squares of 2 x 2 cells to one that covers the grid; ranges of single cells are not stored
  std::pair<float, float> whole_{0, 0};
};

}  // namespace etendue
