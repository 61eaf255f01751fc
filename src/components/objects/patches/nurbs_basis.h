#pragma once
// Decomposition of B-splines into Bézier curves.

#include <string>
#include <vector>

namespace etendue::nurbs {

/// A message if the knots are invalid for a number of control points, else "".
std::string knots_fault(const std::vector<float>& knots, int degree, std::size_t points);

/// An interval between consecutive distinct knots, in which the spline is a polynomial.
struct Span {
  std::size_t knot = 0;  ///< index of the knot at its beginning
  double low = 0, high = 0;
};
/// The spans of the spline's domain, from knot `degree` to the knot `degree` before the last.
std::vector<Span> spans(const std::vector<float>& knots, int degree);

/// The Bézier control values of a spline on a span. Value j is the spline's blossom (polar form) with `low` as argument degree
/// - j times and `high` j times (Ramshaw 1989, "Blossoms are polar forms"), which is equivalent to knot insertion. `values` are
/// the control values of the whole spline, with stride `step`.
template <class T>
void bezier_values(const std::vector<float>& knots, int degree, const Span& span, const T* values, std::size_t step, T* out) {
  T work[16];
  for (int j = 0; j <= degree; ++j) {
    const std::size_t first = span.knot - std::size_t(degree);
    for (int i = 0; i <= degree; ++i) work[i] = values[(first + std::size_t(i)) * step];
    for (int r = 1; r <= degree; ++r) {
      const double x = r <= degree - j ? span.low : span.high;
      for (int i = degree; i >= r; --i) {  // de Boor's algorithm
        const double a = double(knots[first + std::size_t(i)]), b = double(knots[span.knot + std::size_t(i - r + 1)]);
        const double f = (x - a) / (b - a);
        work[i] = (1 - f) * work[i - 1] + f * work[i];
      }
    }
    out[j] = work[degree];
  }
}

}  // namespace etendue::nurbs
