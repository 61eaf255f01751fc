#include "student.h"

#include <algorithm>
#include <cmath>

namespace etendue::verify {
namespace {

/// The continued fraction of the incomplete beta function (Abramowitz & Stegun 1964, 26.5.8), evaluated from the front
/// by the modified Lentz method (Thompson & Barnett 1986). Converges fast for x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300, enough = 1e-15;
  const auto away_from_zero = [](double v) { return std::abs(v) < tiny ? tiny : v; };
  double c = 1, d = 1 / away_from_zero(1 - (a + b) * x / (a + 1)), value = d;
  for (int m = 1; m <= 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double change = 1;
    for (const double coefficient : {even, odd}) {
      d = 1 / away_from_zero(1 + coefficient * d);
      c = away_from_zero(1 + coefficient / c);
      change = c * d;
      value *= change;
    }
    if (std::abs(change - 1) < enough) break;
  }
  return value;
}

}  // namespace

double incomplete_beta(double a, double b, double x) {
  if (!(x > 0)) return 0;
  if (x >= 1) return 1;
  const double factor = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return factor * beta_fraction(a, b, x) / a;
  return 1 - factor * beta_fraction(b, a, 1 - x) / b;
}

double student_two_sided(double t, double freedom) {
  // P(|T| >= t) = I_x(f/2, 1/2) with x = f / (f + t^2)   (Abramowitz & Stegun 26.7.1 and 26.5.27)
  if (std::isnan(t)) return 1;
  if (std::isinf(t)) return 0;
  return std::min(1.0, incomplete_beta(freedom / 2, 0.5, freedom / (freedom + t * t)));
}

double student_upper_quantile(double p, double freedom) {
  double low = 0, high = 1;
  while (student_two_sided(high, freedom) > 2 * p && high < 1e100) high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-12 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (student_two_sided(middle, freedom) > 2 * p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double normal_two_sided_quantile(double p) {
  if (!(p < 1)) return 0;
  if (p < 1e-300) return 37;
  // Newton's method on log erfc(z / sqrt 2) = log p, which is concave. erfc(z / sqrt 2) <= exp(-z^2 / 2), so the start is not
  // below the solution, and no step overshoots it.
  const double wanted = std::log(p);
  double z = std::sqrt(-2 * wanted);
  for (int i = 0; i < 100; ++i) {
    const double tail = std::erfc(z / std::sqrt(2.0));
    const double slope = -std::sqrt(2 / 3.14159265358979323846) * std::exp(-0.5 * z * z) / tail;
    const double step = (wanted - std::log(tail)) / slope;
    z += step;
    if (std::abs(step) < 1e-13 * (1 + z)) break;
  }
  return std::max(z, 0.0);
}

}  // namespace etendue::verify
