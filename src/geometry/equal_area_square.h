#pragma once
// Equal-area mapping between the sphere of directions and a square: equal areas of the square are equal solid angles.

#include <algorithm>
#include <cmath>

namespace etendue {

// The mapping of Clarberg 2008, "Fast equal-area mapping of the (hemi)sphere using SIMD". Let a and b go from -1 to 1 across
// and down the square. The upper half of the sphere, z > 0, is the diamond |a| + |b| < 1, the lower half its four corners,
// folded outwards over the diamond's sides. With r^2 = 1 - |z|, a circle of latitude encloses the fraction r^2 of its
// hemisphere, and the diamond |a| + |b| = r encloses the same fraction of the unit diamond; along the sides of a diamond,
// position is proportional to azimuth.

/// A position in the unit square [0, 1]^2. x grows with the direction's x, y with its y; the centre is +z.
struct SquarePlace {
  double x, y;
};
struct SquareDirection {
  double x, y, z;
};

inline SquarePlace equal_area_place(const SquareDirection& d) {
  // For z near 1, where 1 - |z| would lose digits, r^2 is (x^2 + y^2) / (1 + |z|).
  const double r = std::sqrt((d.x * d.x + d.y * d.y) / (1 + std::abs(d.z)));
  const double quarter = std::atan2(std::abs(d.y), std::abs(d.x)) * 0.63661977236758134308;  // in quarter turns
  double b = quarter * r, a = r - b;
  if (d.z < 0) {
    const double folded = 1 - a;
    a = 1 - b;
    b = folded;
  }
  return {(std::copysign(a, d.x) + 1) / 2, (std::copysign(b, d.y) + 1) / 2};
}

/// The unit direction of a position in the square.
inline SquareDirection equal_area_direction(const SquarePlace& p) {
  const double a = 2 * p.x - 1, b = 2 * p.y - 1;
  double u = std::abs(a), v = std::abs(b);
  const bool upper = u + v <= 1;
  if (!upper) {
    const double folded = 1 - u;
    u = 1 - v;
    v = folded;
  }
  const double r = u + v, angle = r > 0 ? v / r * 1.57079632679489661923 : 0;
  const double ring = r * std::sqrt(std::max(0.0, 2 - r * r)), z = 1 - r * r;  // the sine and the cosine of the latitude
  return {std::copysign(ring * std::cos(angle), a), std::copysign(ring * std::sin(angle), b), upper ? z : -z};
}

/// In an image of n x n texels, wraps texel coordinates at most one texel beyond an edge to the adjacent texel on the sphere:
/// it lies at the same edge, mirrored about the edge's midpoint.
inline void fold_equal_area(int& x, int& y, int n) {
  if (x < 0 || x >= n) {
    x = x < 0 ? 0 : n - 1;
    y = n - 1 - y;
  }
  if (y < 0 || y >= n) {
    y = y < 0 ? 0 : n - 1;
    x = n - 1 - x;
  }
}

}  // namespace etendue
