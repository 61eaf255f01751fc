#pragma once
// Chi-square tests and quadrature over the sphere, for the conformance checks and unit tests.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue::statistics {

/// Probability that a chi-square variable of some degrees of freedom exceeds a value: the regularised upper incomplete
/// gamma function Q(k/2, x/2), by series or continued fraction (Abramowitz & Stegun 6.5.29, 6.5.31).
inline double chi_square_tail(double value, double degrees) {
  const double a = degrees / 2, x = value / 2;
  if (x <= 0) return 1;
  const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && term > sum * 1e-15; ++n) sum += term *= x / (a + n);
    return 1 - front * sum;
  }
  // Lentz's method.
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int i = 1; i < 10000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = an * d + b;
    if (std::abs(d) < 1e-300) d = 1e-300;
    c = b + an / c;
    if (std::abs(c) < 1e-300) c = 1e-300;
    d = 1 / d;
    const double delta = d * c;
    h *= delta;
    if (std::abs(delta - 1) < 1e-15) break;
  }
  return front * h;
}

/// Chi-square test of counts against expected numbers; returns the p-value. Cells that expect fewer than `least` are pooled.
/// The pool may hold up to `missed` samples more than expected, from slivers that quadrature has not resolved.
inline double chi_square(const std::vector<double>& counts, const std::vector<double>& expected, double least = 5,
                         double missed = 0) {
  double statistic = 0, pooled_count = 0, pooled_expected = 0;
  int cells = 0;
  const auto add = [&](double count, double wanted) {
    statistic += (count - wanted) * (count - wanted) / wanted;
    ++cells;
  };
  for (size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= least) {
      add(counts[i], expected[i]);
    } else {
      pooled_count += counts[i];
      pooled_expected += expected[i];
    }
  }
  pooled_count -= std::clamp(pooled_count - pooled_expected, 0.0, missed);
  if (pooled_expected >= 1)
    add(pooled_count, pooled_expected);
  else if (pooled_count > 5 + 10 * pooled_expected)
    return 0;  // samples where hardly any are possible
  return cells > 1 ? chi_square_tail(statistic, cells - 1) : 1;
}

/// The significance of each of several tests for which all together have the given one (Šidák).
inline double each_of(int tests, double together = 1e-3) { return 1 - std::pow(1 - together, 1.0 / tests); }

/// The 6-point Gauss-Legendre rule on [0, 1].
inline const std::array<std::pair<double, double>, 6>& gauss() {
  static const std::array<std::pair<double, double>, 6> rule = [] {
    const double x[3] = {0.238619186083197, 0.661209386466265, 0.932469514203152};
    const double w[3] = {0.467913934572691, 0.360761573048139, 0.171324492379170};
    std::array<std::pair<double, double>, 6> r;
    for (size_t i = 0; i < 3; ++i) {
      r[2 * i] = {(1 - x[i]) / 2, w[i] / 2};
      r[2 * i + 1] = {(1 + x[i]) / 2, w[i] / 2};
    }
    return r;
  }();
  return rule;
}

/// Integrals over cells of the sphere of a function of direction: `rows` steps in z (a border at z = 0 when even) by
/// `columns` steps in longitude, around the frame's normal.
inline std::vector<double> integrate_cells(const Frame& frame, int rows, int columns,
                                           const std::function<double(const Vector3&)>& f) {
  std::vector<double> cells;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      double sum = 0;
      for (const auto& [x, wx] : gauss())
        for (const auto& [y, wy] : gauss()) {
          const double z = -1 + 2 * (row + x) / rows, phi = 2 * M_PI * (column + y) / columns, r = std::sqrt(1 - z * z);
          sum += wx * wy * f(frame.to_world({float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)}));
        }
      cells.push_back(sum * 4 * M_PI / (rows * columns));
    }
  return cells;
}

inline size_t cell_of(const Frame& frame, int rows, int columns, const Vector3& direction) {
  const Vector3 v = frame.to_local(direction);
  double phi = std::atan2(double(v.y), double(v.x)) / (2 * M_PI);
  if (phi < 0) phi += 1;
  const int row = std::min(int((double(v.z) + 1) / 2 * rows), rows - 1), column = std::min(int(phi * columns), columns - 1);
  return size_t(row * columns + column);
}

/// Mean and standard error of numbers that are added one by one.
class Mean {
 public:
  void add(double x) {
    sum_ += x;
    squares_ += x * x;
    largest_ = std::max(largest_, std::abs(x));
    ++count_;
  }
  void add_zeros(long n) { count_ += n; }
  double mean() const { return count_ > 0 ? sum_ / double(count_) : 0; }
  /// Standard error of the mean.
  double error() const {
    if (count_ < 2) return 0;
    const double n = double(count_);
    return std::sqrt(std::max(0.0, squares_ / n - (sum_ / n) * (sum_ / n)) / (n - 1));
  }
  double largest() const { return largest_; }
  long count() const { return count_; }

 private:
  double sum_ = 0, squares_ = 0, largest_ = 0;
  long count_ = 0;
};

}  // namespace etendue::statistics
