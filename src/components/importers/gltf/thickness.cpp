#include "thickness.h"

#include <algorithm>
#include <cmath>

namespace etendue::gltf {

// glTF 2.0, 3.5.3: an object with one scale of zero is shown flat. For a matrix M of rank 2, M + s e_i e_j^T has the
// determinant s C_ij, with C the cofactor matrix: at the largest cofactor the smallest change is needed. The determinant is
// made positive, as for a transform that does not mirror: fronts stay fronts.
std::optional<Transform> with_thickness(const Transform& t) {
  if (t.valid()) return t;
  Transform::DoubleMatrix m = t.exact();
  const auto at = [&](size_t r, size_t c) { return m[4 * (r % 3) + c % 3]; };
  double largest = 0;  // largest element of the matrix
  size_t row = 0, column = 0;
  double best = 0;
  for (size_t r = 0; r < 3; ++r)
    for (size_t c = 0; c < 3; ++c) {
      largest = std::max(largest, std::abs(at(r, c)));
      const double cofactor = at(r + 1, c + 1) * at(r + 2, c + 2) - at(r + 1, c + 2) * at(r + 2, c + 1);
      if (std::abs(cofactor) > std::abs(best)) best = cofactor, row = r, column = c;
    }
  if (!(largest > 0 && std::isfinite(largest)) || !(std::abs(best) > 1e-6 * largest * largest)) return std::nullopt;
  constexpr double thickness = 1e-4;
  m[4 * row + column] += (best > 0 ? 1 : -1) * thickness * largest;
  const Transform made(m);
  return made.valid() ? std::optional(made) : std::nullopt;
}

}  // namespace etendue::gltf
