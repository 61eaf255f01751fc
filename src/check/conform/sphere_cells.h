#pragma once
// Divides the sphere of directions into cells with about equal numbers of samples: small where a pdf is sharp, large where it
// is low. Counts in the cells are compared with integrals over them.

#include <array>
#include <cmath>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue::conform {

/// Each hemisphere of local directions (z >= 0, z < 0) is mapped to a square of edge 2, by area-preserving maps: the concentric
/// map of the square to the disc (Shirley & Chiu 1997), and that of the disc, with radius r = sqrt(1 - |z|), to the hemisphere.
/// A unit of the square is pi / 2 steradian. First what lies far from all samples is cut off; then boxes are halved at the
/// median of samples across their longer side. The halving continues within a cell, down to a few samples per patch, so that
/// quadrature over the cell's patches resolves narrow peaks.
class SphereCells {
 public:
  /// Builds the cells from local directions: about `wanted` cells, at least two.
  SphereCells(const std::vector<Vector3>& samples, size_t wanted);

  size_t size() const { return cells_.size(); }
  size_t cell_of(const Vector3& local) const;
  /// Solid angle [sr].
  double solid_angle(size_t cell) const { return cells_[cell].area() * steradians; }
  /// A direction uniformly distributed in a cell.
  Vector3 uniform(size_t cell, double u, double v) const {
    const Box& c = cells_[cell];
    return direction(c.back, c.x0 + u * (c.x1 - c.x0), c.y0 + v * (c.y1 - c.y0));
  }
  /// A direction in the middle of a cell.
  Vector3 middle(size_t cell) const { return uniform(cell, 0.5, 0.5); }

  /// The integrals over all cells of a function of local direction with N values, of which the first is the pdf of the samples,
  /// to about `tolerance` in the sum of each: 16 Gauss points, and four quarters where these disagree, with at most about
  /// `most` points in all. The subdivision is forced in a patch where the pdf at the samples is so high that they must come
  /// from a small part of it, and in all patches if the tolerance is below 1e-3.
  template <size_t N, class F>
  std::vector<std::array<double, N>> integrate(F&& f, double tolerance = 1e-3, long most = 1000000) const {
    std::vector<std::array<double, N>> integrals(cells_.size(), std::array<double, N>{});
    const double each = tolerance / std::sqrt(double(patches_.size()));
    for (const Patch& p : patches_) {
      // The sum of 1 / pdf over the patch's samples, divided by the number of all samples, estimates the solid angle they come
      // from.
      double covered = p.begin == p.end ? p.box.area() : 0;
      for (size_t i = p.begin; i < p.end; ++i)
        covered += 1 / (f(direction(places_[i].back, places_[i].x, places_[i].y))[0] * double(places_.size()) * steradians);
      // Slivers between the points would be missed: forced subdivision finds them.
      int forced = tolerance < 1e-3 ? 2 : 0;
      for (double share = covered / p.box.area(); share < 0.5 && forced < most_forced; share *= 2) ++forced;
      long left = most / long(patches_.size());
      const std::array<double, N> part = refined<N>(f, p.box, gauss<N>(f, p.box), each, deepest, forced, left);
      for (size_t n = 0; n < N; ++n) integrals[p.cell][n] += part[n];
    }
    return integrals;
  }

 private:
  static constexpr double steradians = 1.57079632679489661923;  // per area of the square
  static constexpr int deepest = 7;                             // maximum number of subdivisions
  static constexpr int most_forced = 4;
  struct Box {
    bool back = false;
    double x0 = -1, x1 = 1, y0 = -1, y1 = 1;
    double area() const { return (x1 - x0) * (y1 - y0); }
    Box quarter(int i) const {
      const double x = (x0 + x1) / 2, y = (y0 + y1) / 2;
      return {back, (i & 1) ? x : x0, (i & 1) ? x1 : x, (i & 2) ? y : y0, (i & 2) ? y1 : y};
    }
  };
  struct Place {
    bool back;
    double x, y;
  };
  /// An inner node splits a box along an axis; a leaf is a patch.
  struct Node {
    int axis = -1;  ///< -1: a leaf
    double at = 0;
    size_t low = 0, high = 0;  ///< children; of a leaf: low is the cell
  };
  struct Patch {
    Box box;
    size_t cell, begin, end;  ///< range of its samples in `places_`
  };
  static constexpr size_t no_cell = size_t(-1), patch_samples = 4;

  static Place place(const Vector3& local);
  static Vector3 direction(bool back, double x, double y);
  /// `cell`: the cell that the box belongs to, if already decided.
  size_t divide(const Box&, size_t begin, size_t end, size_t most, size_t cell);
  /// Finds where to cut off a part that is far from all samples; false: nowhere.
  static bool gap(const Box&, const Place* begin, const Place* end, int& axis, double& at);

  template <size_t N, class F>
  static std::array<double, N> gauss(F&& f, const Box& c) {
    static constexpr double x[4] = {0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026};
    static constexpr double w[4] = {0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727};
    std::array<double, N> sum{};
    const double area = c.area() * steradians;
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k) {
        const std::array<double, N> value = f(direction(c.back, c.x0 + x[i] * (c.x1 - c.x0), c.y0 + x[k] * (c.y1 - c.y0)));
        for (size_t n = 0; n < N; ++n) sum[n] += w[i] * w[k] * area * value[n];
      }
    return sum;
  }

  template <size_t N, class F>
  static std::array<double, N> refined(F&& f, const Box& c, const std::array<double, N>& coarse, double tolerance, int depth,
                                       int forced, long& left) {
    std::array<std::array<double, N>, 4> parts;
    std::array<double, N> sum{};
    for (size_t i = 0; i < 4; ++i) {
      parts[i] = gauss<N>(f, c.quarter(int(i)));
      for (size_t n = 0; n < N; ++n) sum[n] += parts[i][n];
    }
    double difference = 0;
    for (size_t n = 0; n < N; ++n) difference = std::max(difference, std::abs(sum[n] - coarse[n]));
    left -= 64;
    if (forced <= 1 && (!(difference > tolerance) || depth == 0 || left <= 0)) return sum;
    sum = {};
    for (size_t i = 0; i < 4; ++i) {
      const std::array<double, N> fine = refined<N>(f, c.quarter(int(i)), parts[i], tolerance / 2, depth - 1, forced - 1, left);
      for (size_t n = 0; n < N; ++n) sum[n] += fine[n];
    }
    return sum;
  }

  std::vector<Place> places_;  // of the samples
  std::vector<Box> cells_;
  std::vector<Patch> patches_;
  std::vector<Node> nodes_;
  size_t roots_[2];  // front, back
};

}  // namespace etendue::conform
