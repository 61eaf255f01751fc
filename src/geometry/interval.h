#pragma once
// Interval arithmetic: bounds of functions over all numbers of an interval.

#include <algorithm>
#include <cmath>
#include <limits>

// A separate namespace, so that these functions hide no others of the same name; they are found by argument-dependent lookup.
namespace etendue::intervals {

/// The numbers from low to high. The result of an operation contains all values that the operation can take, including
/// rounding. (Moore 1966, "Interval analysis".)
struct Interval {
  double low = 0, high = 0;
  Interval() = default;
  Interval(double x) : low(x), high(x) {}  // NOLINT: a number is an interval
  Interval(double a, double b) : low(a), high(b) {}
  bool contains(double x) const { return low <= x && x <= high; }

  static Interval whole() { return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}; }
  /// [a, b] widened by two units in the last place; all numbers if a bound is NaN.
  static Interval around(double a, double b) {
    constexpr double relative = 2 * std::numeric_limits<double>::epsilon(), least = std::numeric_limits<double>::min();
    const double low = a - relative * std::abs(a) - least, high = b + relative * std::abs(b) + least;
    return low <= high ? Interval{low, high} : whole();
  }
};

/// A product of bounds in which 0 times infinity is 0.
inline double interval_product(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

inline Interval operator+(const Interval& a, const Interval& b) { return Interval::around(a.low + b.low, a.high + b.high); }
inline Interval operator-(const Interval& a, const Interval& b) { return Interval::around(a.low - b.high, a.high - b.low); }
inline Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
inline Interval operator*(const Interval& a, const Interval& b) {
  if (a.low == a.high && a.low == 0) return a;
  if (b.low == b.high && b.low == 0) return b;
  const double p = interval_product(a.low, b.low), q = interval_product(a.low, b.high), r = interval_product(a.high, b.low),
               s = interval_product(a.high, b.high);
  return Interval::around(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}
inline Interval operator/(const Interval& a, const Interval& b) {
  return b.contains(0) ? Interval::whole() : a * Interval::around(1 / b.high, 1 / b.low);
}

inline Interval hull(const Interval& a, const Interval& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }
inline Interval smaller(const Interval& a, const Interval& b) { return {std::min(a.low, b.low), std::min(a.high, b.high)}; }
inline Interval larger(const Interval& a, const Interval& b) { return {std::max(a.low, b.low), std::max(a.high, b.high)}; }
inline Interval absolute(const Interval& a) {
  if (a.low >= 0) return a;
  if (a.high <= 0) return -a;
  return {0, std::max(-a.low, a.high)};
}

/// The square root of negative numbers is taken as 0, as in formulas of the scene description.
inline Interval square_root(const Interval& a) {
  return Interval::around(std::sqrt(std::max(a.low, 0.0)), std::sqrt(std::max(a.high, 0.0)));
}
inline Interval exponential(const Interval& a) { return Interval::around(std::exp(a.low), std::exp(a.high)); }
/// The logarithm of numbers that are not positive is taken as 0, as in formulas of the scene description.
inline Interval logarithm(const Interval& a) {
  if (a.high <= 0) return {0, 0};
  const Interval l = Interval::around(a.low > 0 ? std::log(a.low) : -std::numeric_limits<double>::infinity(), std::log(a.high));
  return a.low > 0 ? l : hull(l, 0);
}
inline Interval sine(const Interval& a) {
  constexpr double turn = 2 * M_PI;
  if (!(a.high - a.low < turn && std::abs(a.low) < 1e12)) return {-1, 1};
  const double s = std::sin(a.low), t = std::sin(a.high), slack = 1e-15 * (1 + std::abs(a.low) + std::abs(a.high));
  // Whether the interval contains x + 2 pi n for an integer n: the extremes of the sine are at x = -pi / 2 and pi / 2.
  const auto between = [&](double x) { return x + turn * std::ceil((a.low - slack - x) / turn) <= a.high + slack; };
  return {between(-M_PI / 2) ? -1 : std::min(s, t) - slack, between(M_PI / 2) ? 1 : std::max(s, t) + slack};
}
inline Interval cosine(const Interval& a) { return sine(a + Interval(M_PI / 2)); }
/// The angle of (x, y). The extremes are at the box's corners unless the box contains the origin or the branch cut.
inline Interval arc_tangent_2(const Interval& y, const Interval& x) {
  if (x.low <= 0 && y.contains(0)) return {-M_PI - 1e-15, M_PI + 1e-15};
  const double p = std::atan2(y.low, x.low), q = std::atan2(y.low, x.high), r = std::atan2(y.high, x.low),
               s = std::atan2(y.high, x.high);
  return Interval::around(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}
/// x^n for integer n.
inline Interval whole_power(const Interval& x, int n) {
  if (n < 0) return Interval(1) / whole_power(x, -n);
  const double a = std::pow(x.low, n), b = std::pow(x.high, n);
  if (n % 2 == 1) return Interval::around(a, b);
  Interval p = Interval::around(x.contains(0) && n > 0 ? 0 : std::min(a, b), std::max(a, b));
  if (n > 0) p.low = std::max(p.low, 0.0);
  return p;
}

}  // namespace etendue::intervals

namespace etendue {
using intervals::Interval;
}
