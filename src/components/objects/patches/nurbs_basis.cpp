#include "nurbs_basis.h"

#include <cmath>

namespace etendue::nurbs {

std::string knots_fault(const std::vector<float>& knots, int degree, std::size_t points) {
  const std::size_t order = std::size_t(degree) + 1, n = knots.size();
  if (points < order)
    return std::to_string(points) + " points are too few for degree " + std::to_string(degree) + ", which needs " +
           std::to_string(order);
  if (n != points + order)
    return std::to_string(points) + " points of degree " + std::to_string(degree) + " need " + std::to_string(points + order) +
           " knots, but " + std::to_string(n) + " are given";
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(knots[i])) return "knot " + std::to_string(i) + " is not finite";
    if (i > 0 && knots[i] < knots[i - 1]) return "knot " + std::to_string(i) + " is less than the one before it";
  }
  // The spline is discontinuous at an inner knot whose multiplicity exceeds the degree.
  for (std::size_t i = 1; i + order < n; ++i)
    if (knots[i] == knots[i + order - 1] && i + order - 1 < n - 1)
      return "knot " + std::to_string(i) + " is repeated more than " + std::to_string(degree) + " times within the spline";
  if (!(knots[order - 1] < knots[n - order])) return "all knots are the same";
  return {};
}

std::vector<Span> spans(const std::vector<float>& knots, int degree) {
  std::vector<Span> found;
  for (std::size_t i = std::size_t(degree); i + std::size_t(degree) + 1 < knots.size(); ++i)
    if (knots[i] < knots[i + 1]) found.push_back({i, double(knots[i]), double(knots[i + 1])});
  return found;
}

}  // namespace etendue::nurbs
