#pragma once
// Splines with knots, taken apart into Bézier curves.

#include <string>
#include <vector>

namespace etendue::nurbs {

/// What is wrong with knots for a number of control points; "" when nothing is.
std::string knots_fault(const std::vector<float>& knots, int degree, std::size_t points);

/// An interval between different knots in which the spline is a polynomial.
struct Span {
  std::size_t knot = 0;  ///< it begins at this knot
  double low = 0, high = 0;
};
/// The spans of the domain, from knot `degree` to the last but `degree`.
std::vector<Span> spans(const std::vector<float>& knots, int degree);

/// The Bézier control values of a spline on a span. Value j is the spline's blossom, of `low` degree - j times and of `high`
/// j times (Ramshaw 1989, "Blossoms are polar forms"): what inserting knots comes to. `values` are those of the whole spline,
/// `step` apart.
template <class T>
void bezier_values(const std::vector<float>& knots, int degree, const Span& span, const T* values, std::size_t step, T* out) {
  T work[16];
  for (int j = 0; j <= degree; ++j) {
    const std::size_t first = span.knot - std::size_t(degree);
    for (int i = 0; i <= degree; ++i) work[i] = values[(first + std::size_t(i)) * step];
    for (int r = 1; r <= degree; ++r) {
      const double x = r <= degree - j ? span.low : span.high;
      for (int i = degree; i >= r; --i) {  // de Boor's scheme
        const double a = double(knots[first + std::size_t(i)]), b = double(knots[span.knot + std::size_t(i - r + 1)]);
        const double f = (x - a) / (b - a);
        work[i] = (1 - f) * work[i - 1] + f * work[i];
      }
    }
    out[j] = work[degree];
  }
}

}  // namespace etendue::nurbs
