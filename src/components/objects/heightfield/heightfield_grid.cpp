#include "heightfield_grid.h"

#include <tbb/parallel_for.h>

namespace etendue {

HeightfieldGrid::HeightfieldGrid(std::vector<float> heights, int nx, int ny) : heights_(std::move(heights)), nx_(nx), ny_(ny) {
  int wide = cells_x(), high = cells_y();
  do {
    Level level{(wide + 1) / 2, (high + 1) / 2, {}};
    level.ranges.resize(size_t(level.nx) * size_t(level.ny));
    const int below = int(levels_.size());
    tbb::parallel_for(0, level.ny, [&](int j) {
      for (int i = 0; i < level.nx; ++i) {
        Range r{infinity, -infinity};
        for (int y = 2 * j; y < std::min(2 * j + 2, high); ++y)
          for (int x = 2 * i; x < std::min(2 * i + 2, wide); ++x) {
            const Range part = range_of(below, x, y);
            r = {std::min(r.low, part.low), std::max(r.high, part.high)};
          }
        level.ranges[size_t(j) * size_t(level.nx) + size_t(i)] = r;
      }
    });
    wide = level.nx;
    high = level.ny;
    levels_.push_back(std::move(level));
  } while (wide > 1 || high > 1);
  whole_ = {levels_.back().ranges[0].low, levels_.back().ranges[0].high};
}

HeightfieldGrid::Range HeightfieldGrid::range_of(int level, int i, int j) const {
  if (level > 0) {
    const Level& l = levels_[size_t(level - 1)];
    return l.ranges[size_t(j) * size_t(l.nx) + size_t(i)];
  }
  const float* row = heights_.data() + size_t(j) * size_t(nx_) + size_t(i);
  const auto [low, high] = std::minmax({row[0], row[1], row[nx_], row[nx_ + 1]});
  return {low, high};
}

std::pair<double, double> HeightfieldGrid::corner_slopes(int i, int j) const {
  const int left = std::max(i - 1, 0), right = std::min(i + 1, nx_ - 1), below = std::max(j - 1, 0),
            above = std::min(j + 1, ny_ - 1);
  return {(at(right, j) - at(left, j)) / (right - left), (at(i, above) - at(i, below)) / (above - below)};
}

// Hierarchical traversal, front to back, of the squares whose range of heights the ray enters (Tevs, Ihrke & Seidel 2008,
// "Maximum mipmaps for fast, accurate, and scalable dynamic height field rendering"). Over a cell the ray's height above the
// surface is a quadratic in t. Squares are slightly enlarged, so that no hit is missed between neighbours; the surface is
// continuous, so a point found in two neighbouring cells is the same.
bool HeightfieldGrid::nearest(const double (&o)[3], const double (&d)[3], float maximum, Found& found) const {
  constexpr double margin = 1e-7;  // [cells]
  const double rise = 1e-7 * double(whole_.second - whole_.first) + 1e-12 * std::abs(double(whole_.second)) +
                      1e-12 * std::abs(double(whole_.first)) + 1e-14 * std::abs(o[2]);
  const double inverse[3] = {1 / d[0], 1 / d[1], 1 / d[2]};
  float best = maximum;
  bool any = false;
  /// Clips the range of t to a slab across axis k.
  const auto clip = [&](int k, double low, double high, double& enter, double& leave) {
    if (d[k] == 0) return o[k] >= low && o[k] <= high;
    double t0 = (low - o[k]) * inverse[k], t1 = (high - o[k]) * inverse[k];
    if (t0 > t1) std::swap(t0, t1);
    enter = std::max(enter, t0);
    leave = std::min(leave, t1);
    return enter <= leave;
  };
  const auto test_cell = [&](int i, int j, double enter, double leave) {
    const Cell c = cell(i, j);
    const double u = o[0] + enter * d[0] - i, v = o[1] + enter * d[1] - j;
    const double qa = -c.c * d[0] * d[1], qb = d[2] - c.slope_u(v) * d[0] - c.slope_v(u) * d[1],
                 qc = o[2] + enter * d[2] - c.height(u, v);
    const double discriminant = qb * qb - 4 * qa * qc;
    if (!(discriminant >= 0)) return;
    const double root = -0.5 * (qb + std::copysign(std::sqrt(discriminant), qb));
    for (const double s : {root / qa, qc / root}) {  // one may be infinite or NaN: then all tests fail
      const float t = float(enter + s);
      if (!(s >= 0 && enter + s <= leave && t > 0 && t < best)) continue;
      best = t;
      found = {i, j, std::clamp(u + s * d[0], 0.0, 1.0), std::clamp(v + s * d[1], 0.0, 1.0), t};
      any = true;
    }
  };

  struct Square {
    int level, i, j;
  } stack[80];
  int size = 0;
  stack[size++] = {int(levels_.size()), 0, 0};
  const int flip_x = d[0] < 0, flip_y = d[1] < 0;
  while (size > 0) {
    const Square s = stack[--size];
    const double wide = double(1 << s.level);
    const Range r = range_of(s.level, s.i, s.j);
    // The range includes t < 0: the test t > 0 is done on the rounded float.
    double enter = -infinity, leave = infinity;
    if (!clip(0, s.i * wide - margin, std::min((s.i + 1) * wide, double(cells_x())) + margin, enter, leave) ||
        !clip(1, s.j * wide - margin, std::min((s.j + 1) * wide, double(cells_y())) + margin, enter, leave) ||
        !clip(2, double(r.low) - rise, double(r.high) + rise, enter, leave) || leave <= 0 || enter >= double(best))
      continue;
    if (s.level == 0) {
      test_cell(s.i, s.j, enter, leave);
      continue;
    }
    const int below_x = s.level > 1 ? levels_[size_t(s.level - 2)].nx : cells_x(),
              below_y = s.level > 1 ? levels_[size_t(s.level - 2)].ny : cells_y();
    for (int k = 3; k >= 0; --k) {  // the nearest is pushed last, so that it is popped first
      const int i = 2 * s.i + ((k & 1) ^ flip_x), j = 2 * s.j + ((k >> 1) ^ flip_y);
      if (i < below_x && j < below_y) stack[size++] = {s.level - 1, i, j};
    }
  }
  return any;
}

}  // namespace etendue
