#include "usable_triangles.h"

#include <algorithm>
#include <cmath>

namespace etendue {

bool countable(const Point3& p) {
  constexpr float largest = 1e18f;  // squares of coordinates must stay finite; Embree requires the same
  return std::abs(p.x) < largest && std::abs(p.y) < largest && std::abs(p.z) < largest;  // false for NaN
}

bool without_height(const Point3& a, const Point3& b, const Point3& c) {
  double e1[3], e2[3], longest = 0;
  for (int k = 0; k < 3; ++k) {
    e1[k] = double(b[k]) - double(a[k]);
    e2[k] = double(c[k]) - double(a[k]);
    longest = std::max({longest, std::abs(e1[k]), std::abs(e2[k])});
  }
  const double x = e1[1] * e2[2] - e1[2] * e2[1], y = e1[2] * e2[0] - e1[0] * e2[2], z = e1[0] * e2[1] - e1[1] * e2[0];
  const double least = 1e-7 * longest * longest;
  return !(x * x + y * y + z * z > least * least) || longest < 1e-18;
}

bool any_usable(std::span<const Point3> positions, std::span<const std::array<std::uint32_t, 3>> triangles) {
  return std::ranges::any_of(triangles, [&](const auto& t) {
    const Point3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
    return countable(a) && countable(b) && countable(c) && !without_height(a, b, c);
  });
}

}  // namespace etendue
