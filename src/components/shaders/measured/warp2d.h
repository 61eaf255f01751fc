#pragma once
// Warp2D: tabulated pdfs on the unit square, sampled exactly.
//
// For each point of a grid of two parameters there is a table of values on a grid of the square, interpolated bilinearly;
// between the points of the parameter grid, the neighbours' tables are blended linearly. Each table is normalized, so every
// blend is a pdf. A point is sampled in two steps (as in Dupuy & Jakob 2018, "An adaptive parameterization for efficient
// material acquisition and rendering"): y by the marginal pdf, which is piecewise linear, and x by the conditional pdf on that
// line, piecewise linear too. Integrals of tables blend as the tables do, so the running sums of all tables are computed once
// and blended at each call.

#include <array>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// The tables to blend for a pair of parameters, and their weights. Tables of weight 0 are left out.
struct TableBlend {
  int count = 0;
  std::array<std::uint32_t, 4> table{};
  std::array<float, 4> weight{};
};

/// A grid of two parameters; values outside are clamped to it.
class ParameterGrid {
 public:
  ParameterGrid() = default;
  /// Values of each parameter: at least one, increasing.
  ParameterGrid(std::vector<float> first, std::vector<float> second) : first_(std::move(first)), second_(std::move(second)) {}

  size_t size() const { return first_.size() * second_.size(); }
  const std::vector<float>& first() const { return first_; }
  const std::vector<float>& second() const { return second_; }
  /// Tables are stored with the second parameter running faster.
  TableBlend locate(float first, float second) const;

 private:
  std::vector<float> first_{0}, second_{0};
};

/// The interval of an increasing list that contains a value, by the index of its lower end, and the fraction of the way to the
/// upper end; values outside are clamped.
std::pair<std::uint32_t, float> find_interval(const std::vector<float>& increasing, float value);

/// Tables of numbers on the unit square, bilinear between their points: `width` along x, which runs fastest, by `height`.
/// With several channels, those of a point lie side by side.
class SquareTables {
 public:
  SquareTables() = default;
  SquareTables(int width, int height, int channels, std::vector<float> values)
      : width_(width), height_(height), channels_(channels), values_(std::move(values)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }
  std::vector<float>& values() { return values_; }
  const std::vector<float>& values() const { return values_; }
  size_t points() const { return size_t(width_) * size_t(height_); }

  /// The four table points around a point: the index of the first, within one table, and the fractions between them.
  struct Cell {
    size_t index = 0;
    float x = 0, y = 0;
  };
  Cell cell(Point2 p) const;
  /// Calls visit(pointer to a point's channels, weight) for all table points that contribute to the interpolated value at p.
  template <class Visit>
  void gather(Point2 p, const TableBlend& blend, Visit&& visit) const {
    const Cell c = cell(p);
    const size_t w = size_t(width_);
    const float corner[4] = {(1 - c.x) * (1 - c.y), c.x * (1 - c.y), (1 - c.x) * c.y, c.x * c.y};
    const size_t offset[4] = {0, 1, w, w + 1};
    for (int k = 0; k < blend.count; ++k) {
      const size_t base = blend.table[size_t(k)] * points() + c.index;
      for (size_t i = 0; i < 4; ++i)
        visit(&values_[(base + offset[i]) * size_t(channels_)], blend.weight[size_t(k)] * corner[i]);
    }
  }
  /// The value of tables with one channel.
  float at(Point2 p, const TableBlend& blend) const {
    float sum = 0;
    gather(p, blend, [&](const float* v, float weight) { sum += weight * *v; });
    return sum;
  }

 private:
  int width_ = 0, height_ = 0, channels_ = 1;
  std::vector<float> values_;
};

class Warp2D {
 public:
  Warp2D() = default;
  /// From values >= 0 at the points of all tables; `width` and `height` are at least 2. A table of zeros becomes uniform.
  Warp2D(int width, int height, std::vector<float> values);

  struct Placed {
    Point2 point;
    float pdf = 0;  ///< per unit area of the square, at the warped point
  };
  /// Warps uniform random numbers to a point; returns it with its pdf.
  Placed sample(Point2 u, const TableBlend&) const;
  /// The inverse: the random numbers that `sample` warps to p, with the pdf of p.
  Placed invert(Point2 p, const TableBlend&) const;
  float pdf(Point2 p, const TableBlend& blend) const { return tables_.at(p, blend); }

 private:
  /// One number blended over the tables: `i` is its index within a table of `size` numbers.
  static float blended(const std::vector<float>& numbers, size_t size, size_t i, const TableBlend& blend) {
    float sum = 0;
    for (int k = 0; k < blend.count; ++k) sum += blend.weight[size_t(k)] * numbers[blend.table[size_t(k)] * size + i];
    return sum;
  }
  float value(size_t i, const TableBlend& b) const { return blended(tables_.values(), tables_.points(), i, b); }
  float below(size_t row, const TableBlend& b) const { return blended(marginal_, size_t(tables_.height()), row, b); }
  float left(size_t i, const TableBlend& b) const { return blended(conditional_, tables_.points(), i, b); }

  SquareTables tables_;
  std::vector<float> marginal_;     // integral over the square below a row
  std::vector<float> conditional_;  // for each point, the integral along its row to the left of it
};

}  // namespace etendue
