#include "bezier_cells.h"

#include <algorithm>
#include <limits>

namespace etendue::bezier {
namespace {

// A cell is fine enough if, for a ray along the normal, `deviation` changes the solution of the cell's linear approximation by
// no more than this fraction of the cell. Rays with a cosine to the normal above about good / contraction then need no further
// subdivision (bezier_roots.cpp).
constexpr double good = 0.11;
constexpr int deepest = 6, deepest_of_both = 10;

struct Piece {
  Control net[most_points];
  double s0 = 0, s1 = 1, t0 = 0, t1 = 1;
  int depth_s = 0, depth_t = 0;
};

class Cutter {
 public:
  Cutter(const Patch& patch, std::uint32_t number, std::vector<Cell>& cells, std::vector<Bounds3>& boxes)
      : patch_(patch), number_(number), cells_(cells), boxes_(boxes) {}

  void cut(const Piece& p) {
    Cell cell;
    cell.patch = number_;
    cell.s = (p.s0 + p.s1) / 2;
    cell.t = (p.t0 + p.t1) / 2;
    cell.s_half = (p.s1 - p.s0) / 2;
    cell.t_half = (p.t1 - p.t0) / 2;
    const Derivatives d = evaluate(patch_, cell.s, cell.t);
    cell.middle = d.position;
    cell.dx = cell.s_half * d.ds;
    cell.dy = cell.t_half * d.dt;
    cell.deviation = deviation(p, cell);
    const bool may_s = p.depth_s < deepest, may_t = p.depth_t < deepest;
    const double reach = std::max(length(cell.dx), length(cell.dy));
    const bool enough = cell.deviation * reach <= good * length(cross(cell.dx, cell.dy)) && reach > 0;
    if (enough || p.depth_s + p.depth_t >= deepest_of_both || !(may_s || may_t)) {
      cells_.push_back(cell);
      boxes_.push_back(box(p));
      return;
    }
    const bool along_s = may_s && (!may_t || bends_along_s(p));
    Piece low = p, high = p;
    split(patch_.m, patch_.n, along_s, 0.5, p.net, low.net, high.net);
    ++(along_s ? low.depth_s : low.depth_t);
    ++(along_s ? high.depth_s : high.depth_t);
    (along_s ? low.s1 : low.t1) = (along_s ? high.s0 : high.t0) = along_s ? cell.s : cell.t;
    cut(low);
    cut(high);
  }

 private:
  const Control& at(const Piece& p, int i, int j) const { return p.net[i + j * (patch_.m + 1)]; }

  /// With A = w (S - middle): S_x - dx = (A_x - w dx) / w - A w_x / w^2. A, w and their derivatives lie in the convex hulls of
  /// their control values, and A_x - w dx vanishes at the cell's centre.
  double deviation(const Piece& p, const Cell& cell) const {
    const int m = patch_.m, n = patch_.n;
    double low = std::numeric_limits<double>::infinity(), high = 0, reach = 0;
    const auto moved = [&](int i, int j) {
      const Control& c = at(p, i, j);
      return Vector{c[0], c[1], c[2]} - c[3] * cell.middle;
    };
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= m; ++i) {
        low = std::min(low, at(p, i, j)[3]);
        high = std::max(high, at(p, i, j)[3]);
        reach = std::max(reach, length(moved(i, j)));
      }
    const double middle_weight = (low + high) / 2, weight_range = (high - low) / 2;
    double sum = 0;
    for (const bool along_s : {true, false}) {
      const double half_degree = 0.5 * (along_s ? m : n);  // x and y range over an interval of length 2
      const Vector& derivative = along_s ? cell.dx : cell.dy;
      double off = 0, weight_slope = 0;
      for (int j = 0; j <= n - !along_s; ++j)
        for (int i = 0; i <= m - along_s; ++i) {
          const int i1 = i + along_s, j1 = j + !along_s;
          off = std::max(off, length(half_degree * (moved(i1, j1) - moved(i, j)) - middle_weight * derivative));
          weight_slope = std::max(weight_slope, half_degree * std::abs(at(p, i1, j1)[3] - at(p, i, j)[3]));
        }
      sum += (off + weight_range * length(derivative)) / low + reach * weight_slope / (low * low);
    }
    return sum;
  }

  /// Whether to split along s: the direction with the larger second differences or, if these are small, the longer one.
  bool bends_along_s(const Piece& p) const {
    const int m = patch_.m, n = patch_.n;
    const auto place = [&](int i, int j) { return position(at(p, i, j)); };
    double s = 0, t = 0, first_s = 0, first_t = 0;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= m; ++i) {
        if (i < m) first_s = std::max(first_s, m * length(place(i + 1, j) - place(i, j)));
        if (j < n) first_t = std::max(first_t, n * length(place(i, j + 1) - place(i, j)));
        if (i + 1 < m) s = std::max(s, m * (m - 1) * length(place(i + 2, j) - 2 * place(i + 1, j) + place(i, j)));
        if (j + 1 < n) t = std::max(t, n * (n - 1) * length(place(i, j + 2) - 2 * place(i, j + 1) + place(i, j)));
      }
    return std::max(s, t) > 0.05 * std::max(first_s, first_t) ? s >= t : first_s >= first_t;
  }

  Bounds3 box(const Piece& p) const {
    // For the rounding of the net in double; nextafter below covers the rounding to float.
    const float margin = float(patch_.size * 1e-12);
    Bounds3 b;
    for (int k = 0; k < (patch_.m + 1) * (patch_.n + 1); ++k) {
      const Vector v = position(p.net[k]);
      b.add(Point3{float(v.x), float(v.y), float(v.z)});
    }
    for (int k = 0; k < 3; ++k) {
      b.low[k] = std::nextafter(b.low[k], -infinity) - margin;
      b.high[k] = std::nextafter(b.high[k], infinity) + margin;
    }
    return b;
  }

  const Patch& patch_;
  const std::uint32_t number_;
  std::vector<Cell>& cells_;
  std::vector<Bounds3>& boxes_;
};

}  // namespace

void cut(const Patch& patch, std::uint32_t number, std::vector<Cell>& cells, std::vector<Bounds3>& boxes) {
  Piece whole;
  std::copy(patch.points.begin(), patch.points.end(), whole.net);
  Cutter(patch, number, cells, boxes).cut(whole);
}

}  // namespace etendue::bezier
