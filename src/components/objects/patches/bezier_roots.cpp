#include "bezier_roots.h"

#include <algorithm>

namespace etendue::bezier {
namespace {

// Cells are enlarged by this factor, so that rounding opens no gaps between neighbouring cells.
constexpr double border = 1 + 1e-9;
// Newton's method stops at steps below this fraction of a cell: the remaining error is about its square.
constexpr double small_step = 1e-7;
// With F the difference of surface and ray, J its Jacobian and Y the inverse of J at the centre of a cell, let |1 - Y J| <= k
// in the maximum norm. For k < 1/3, a Newton step from anywhere in the cell reduces the distance to the root by the factor 2 k
// / (1 - k) < 1, also if the step is then clamped to the cell: there is at most one root, and Newton's method finds it from any
// start. (The mean value theorem, as for the operators of Krawczyk 1969; for patches, Toth 1985, "On ray tracing parametric
// surfaces".)
constexpr double contraction = 0.3;

class Solver {
 public:
  Solver(const Patch& patch, const Cell& cell, const Line& line, double maximum, const Region& region, Root& root)
      : patch_(patch), cell_(cell), line_(line), region_(region), root_(root), maximum_(maximum) {}

  bool solve() {
    // The linear approximation middle + x dx + y dy = origin + t direction, by Cramer's rule. The neglected terms change x and
    // y by up to deviation * |gradient|.
    const Vector &d = line_.direction, from = line_.origin - cell_.middle;
    const Vector a = cross(cell_.dy, d), b = cross(d, cell_.dx);
    const double determinant = dot(cell_.dx, a);
    const double largest = std::max(dot(a, a), dot(b, b)) * cell_.deviation * cell_.deviation;
    if (largest < contraction * contraction * determinant * determinant) {
      const double k = std::sqrt(largest) / std::abs(determinant), x = dot(a, from) / determinant,
                   y = dot(b, from) / determinant;
      // |root - (x, y)| <= k |root|
      if (std::abs(x) > border + 1.01 * k || std::abs(y) > border + 1.01 * k) return false;
      newton(std::clamp(x, -1.0, 1.0), std::clamp(y, -1.0, 1.0));
    } else if (may_graze(from)) {
      search();
    }
    return found_;
  }

 private:
  /// Whether the line may hit the cell: tests, in two directions perpendicular to the line, the distance of the line from the
  /// cell's centre against the cell's extent.
  bool may_graze(const Vector& from) const {
    const Vector& d = line_.direction;
    const Vector across = cross(cross(cell_.dx, cell_.dy), d), up = cross(d, across);
    const auto inside = [&](const Vector& v) {
      return std::abs(dot(from, v)) <=
             (std::abs(dot(cell_.dx, v)) + std::abs(dot(cell_.dy, v)) + cell_.deviation * length(v)) * border;
    };
    return inside(up) && inside(across);
  }

  void newton(double x, double y) {
    for (int i = 0; i < 50; ++i) {
      const double s = cell_.s + x * cell_.s_half, t = cell_.t + y * cell_.t_half;
      const Derivatives at = evaluate(patch_, s, t);
      const Vector &d = line_.direction, from = line_.origin - at.position;
      const Vector du = cell_.s_half * at.ds, dv = cell_.t_half * at.dt;
      const Vector a = cross(dv, d);
      const double inverse = 1 / dot(du, a);
      const double step_x = inverse * dot(a, from), step_y = inverse * dot(cross(d, du), from);
      const double to_x = std::clamp(x + step_x, -border, border), to_y = std::clamp(y + step_y, -border, border);
      const double moved = std::max(std::abs(to_x - x), std::abs(to_y - y));
      if (!(moved > small_step)) {
        if (to_x != x + step_x || to_y != y + step_y) return;  // the step was clamped: the root is outside the cell
        accept(to_x, to_y, dot(step_x * du + step_y * dv - from, d) / dot(d, d));
        return;
      }
      x = to_x;
      y = to_y;
    }
  }

  void accept(double x, double y, double distance) {
    const double s = std::clamp(cell_.s + x * cell_.s_half, 0.0, 1.0), t = std::clamp(cell_.t + y * cell_.t_half, 0.0, 1.0);
    if (!(distance > 0 && distance < maximum_) || !region_.contains(cell_.patch, s, t)) return;
    maximum_ = distance;
    root_ = {distance, s, t, cell_.patch};
    found_ = true;
  }

  // ---- grazing rays, and cells at degenerate edges --------------------------------------------------------------------

  // The ray is represented by two planes. The surface's distances from them are two polynomials of (s, t), which both vanish at
  // roots (Kajiya 1982; Nishita, Sederberg & Kakimoto 1990). Pieces whose control values all lie on one side of a plane are
  // discarded; others are bisected until Newton's method is certain to converge on them.
  struct Pair {
    double a, b;  // not initialized, since nets of pairs are large
    Pair operator+(const Pair& p) const { return {a + p.a, b + p.b}; }
    Pair operator-(const Pair& p) const { return {a - p.a, b - p.b}; }
    friend Pair operator*(double f, const Pair& p) { return {f * p.a, f * p.b}; }
    double square() const { return a * a + b * b; }
  };
  struct Piece {
    double x0, x1, y0, y1;  // in cell coordinates
  };

  void search() {
    const Vector& d = line_.direction;
    const double scale = patch_.size + length(line_.origin);
    smallest_ = 1e-14 * scale;
    // One of the planes contains the cell's normal: the cell is thin in the direction perpendicular to the other plane.
    Vector p = cross(d, cross(cell_.dx, cell_.dy));
    if (!(length(p) > 1e-6 * length(d) * length(cell_.dx) * length(cell_.dy)))
      p = cross(d, std::abs(d.x) < 0.6 * length(d) ? Vector{1, 0, 0} : Vector{0, 1, 0});
    p = (1 / length(p)) * p;
    const Vector q = (1 / length(d)) * cross(d, p);
    Pair net[most_points], unused[most_points];
    const int m = patch_.m, n = patch_.n;
    for (int k = 0; k < (m + 1) * (n + 1); ++k) {
      const Control& c = patch_.points[k];
      const Vector from = Vector{c[0], c[1], c[2]} - c[3] * line_.origin;
      net[k] = {dot(p, from), dot(q, from)};
    }
    for (const bool along_s : {true, false}) {
      const double middle = along_s ? cell_.s : cell_.t, half = along_s ? cell_.s_half : cell_.t_half;
      if (middle + half < 1) split(m, n, along_s, middle + half, net, net, unused);
      if (middle - half > 0) split(m, n, along_s, (middle - half) / (middle + half), net, unused, net);
    }
    search(net, {-1, 1, -1, 1}, 0);
  }

  void search(const Pair* net, const Piece& piece, int depth) {
    const int m = patch_.m, n = patch_.n;
    if (--budget_ < 0) return;
    Pair low = net[0], high = net[0];
    for (int k = 1; k < (m + 1) * (n + 1); ++k) {
      low = {std::min(low.a, net[k].a), std::min(low.b, net[k].b)};
      high = {std::max(high.a, net[k].a), std::max(high.b, net[k].b)};
    }
    if (low.a > smallest_ || low.b > smallest_ || high.a < -smallest_ || high.b < -smallest_) return;
    if (std::max(high.a - low.a, high.b - low.b) < 4 * smallest_ || depth > deepest) {
      const double x = (piece.x0 + piece.x1) / 2, y = (piece.y0 + piece.y1) / 2;
      accept_at(x, y);
      return;
    }
    Pair dx{}, dy{};
    double off = 0, size_x = 0, size_y = 0;
    slopes(net, true, dx, off, size_x);
    slopes(net, false, dy, off, size_y);
    const double determinant = dx.a * dy.b - dx.b * dy.a;
    if (off * std::sqrt(std::max(dx.square(), dy.square())) < contraction * std::abs(determinant)) {
      newton(net, piece);
      return;
    }
    const bool along_x = size_x > size_y;
    Pair lower[most_points], upper[most_points];
    split(m, n, along_x, 0.5, net, lower, upper);
    Piece first = piece, second = piece;
    (along_x ? first.x1 : first.y1) = (along_x ? second.x0 : second.y0) =
        along_x ? (piece.x0 + piece.x1) / 2 : (piece.y0 + piece.y1) / 2;
    search(lower, first, depth + 1);
    search(upper, second, depth + 1);
  }

  /// The mean derivative over a piece with coordinates from -1 to 1; adds the largest deviation from the mean to `off`, and
  /// raises `size` to the square of the largest derivative.
  void slopes(const Pair* net, bool along_x, Pair& mean, double& off, double& size) const {
    const int m = patch_.m, n = patch_.n, columns = along_x ? m : m + 1, rows = along_x ? n + 1 : n;
    const int step = along_x ? 1 : m + 1;
    const double half_degree = 0.5 * (along_x ? m : n);
    mean = {};
    const auto at = [&](int i, int j) {
      const Pair* p = net + i + j * (m + 1);
      return half_degree * (p[step] - p[0]);
    };
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) mean = mean + at(i, j);
    mean = (1.0 / (rows * columns)) * mean;
    double largest = 0;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const Pair slope = at(i, j);
        largest = std::max(largest, (slope - mean).square());
        size = std::max(size, slope.square());
      }
    off += std::sqrt(largest);
  }

  void newton(const Pair* net, const Piece& piece) {
    const int m = patch_.m, n = patch_.n;
    double x = 0, y = 0;
    for (int k = 0; k < 60; ++k) {
      double bx[highest_degree + 1], dx[highest_degree + 1], by[highest_degree + 1], dy[highest_degree + 1];
      bernstein(m, (x + 1) / 2, bx, dx);
      bernstein(n, (y + 1) / 2, by, dy);
      Pair f{}, fx{}, fy{};
      for (int j = 0; j <= n; ++j) {
        Pair row{}, slope{};
        for (int i = 0; i <= m; ++i) {
          row = row + bx[i] * net[i + j * (m + 1)];
          slope = slope + dx[i] * net[i + j * (m + 1)];
        }
        f = f + by[j] * row;
        fx = fx + (0.5 * by[j]) * slope;
        fy = fy + (0.5 * dy[j]) * row;
      }
      const double determinant = fx.a * fy.b - fx.b * fy.a;
      const double step_x = (fy.a * f.b - fy.b * f.a) / determinant, step_y = (fx.b * f.a - fx.a * f.b) / determinant;
      const double to_x = std::clamp(x + step_x, -border, border), to_y = std::clamp(y + step_y, -border, border);
      const double moved = std::max(std::abs(to_x - x), std::abs(to_y - y));
      const bool held = to_x != x + step_x || to_y != y + step_y;
      x = to_x;
      y = to_y;
      if (moved > small_step) continue;
      if (!held) accept_at((piece.x0 * (1 - x) + piece.x1 * (1 + x)) / 2, (piece.y0 * (1 - y) + piece.y1 * (1 + y)) / 2);
      return;
    }
  }

  void accept_at(double x, double y) {
    const Derivatives at = evaluate(patch_, cell_.s + x * cell_.s_half, cell_.t + y * cell_.t_half);
    accept(x, y, dot(at.position - line_.origin, line_.direction) / dot(line_.direction, line_.direction));
  }

  static constexpr int deepest = 80;

  const Patch& patch_;
  const Cell& cell_;
  const Line& line_;
  const Region& region_;
  Root& root_;
  double maximum_, smallest_ = 0;
  // A ray that lies in the surface has infinitely many roots: the search ends after this number of pieces.
  int budget_ = 2000;
  bool found_ = false;
};

}  // namespace

bool nearest_root(const Patch& patch, const Cell& cell, const Line& line, double maximum, const Region& region, Root& root) {
  return Solver(patch, cell, line, maximum, region, root).solve();
}

}  // namespace etendue::bezier
