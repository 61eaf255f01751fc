#include "ellipsoid_area.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

/// Carlson's symmetric integral R_G of the second kind, of positive numbers, to about 1e-14. By the duplication theorem
/// (Carlson 1995, "Numerical computation of real or complex elliptic integrals"): each step brings the arguments of R_F and R_D
/// closer together, until a Taylor series around their mean is accurate. With the middle argument as z no term of
///   2 R_G = z R_F - (x - z) (y - z) R_D / 3 + sqrt(x y / z)                                      (DLMF 19.21.10)
/// is negative.
double carlson_g(double x, double z, double y) {
  if (x > z) std::swap(x, z);
  if (z > y) std::swap(z, y);
  if (x > z) std::swap(x, z);
  double fx = x, fy = y, fz = z, sum = 0, factor = 1;
  double xf = 0, yf = 0, zf = 0, mean_f = 1, xd = 0, yd = 0, zd = 0, mean_d = 1;
  for (int i = 0; i < 200; ++i) {
    mean_f = (fx + fy + fz) / 3;
    mean_d = (fx + fy + 3 * fz) / 5;
    xf = 1 - fx / mean_f, yf = 1 - fy / mean_f, zf = -xf - yf;
    xd = 1 - fx / mean_d, yd = 1 - fy / mean_d, zd = -(xd + yd) / 3;
    if (std::max({std::abs(xd), std::abs(yd), std::abs(zd)}) < 1e-3) break;
    const double sx = std::sqrt(fx), sy = std::sqrt(fy), sz = std::sqrt(fz), lambda = sx * sy + sy * sz + sz * sx;
    sum += factor / (sz * (fz + lambda));
    factor /= 4;
    fx = (fx + lambda) / 4;
    fy = (fy + lambda) / 4;
    fz = (fz + lambda) / 4;
  }
  const double e2f = xf * yf - zf * zf, e3f = xf * yf * zf;
  const double rf = (1 - e2f / 10 + e3f / 14 + e2f * e2f / 24 - 3 * e2f * e3f / 44) / std::sqrt(mean_f);
  const double xy = xd * yd, zz = zd * zd;
  const double e2 = xy - 6 * zz, e3 = (3 * xy - 8 * zz) * zd, e4 = 3 * (xy - zz) * zz, e5 = xy * zz * zd;
  const double series = 1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 - 9 * e2 * e3 / 52 + 3 * e5 / 26;
  const double rd = factor * series / (mean_d * std::sqrt(mean_d)) + 3 * sum;
  return 0.5 * (z * rf - (x - z) * (y - z) * rd / 3 + std::sqrt(x / z * y));
}

}  // namespace

/// Any affine image of an ellipsoid is an ellipsoid; its area is 4 pi R_G of the squared pairwise products of its half axes
/// (DLMF 19.33.1). These squares are the eigenvalues of C^T C, where C is the cofactor matrix of the map from the unit sphere;
/// they are computed trigonometrically (Smith 1961, "Eigenvalues of a symmetric 3 x 3 matrix").
double ellipsoid_area(const Transform& t, const Vector3& radii) {
  const Transform::Matrix& m = t.matrix();
  double l[3][3], c[3][3], g[3][3], scale = 0;
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) {
      l[i][k] = double(m[4 * i + k]) * double(radii[int(k)]);
      scale = std::max(scale, std::abs(l[i][k]));
    }
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) {
      const size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      c[i][k] = (l[i1][k1] / scale) * (l[i2][k2] / scale) - (l[i1][k2] / scale) * (l[i2][k1] / scale);
    }
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) g[i][k] = c[0][i] * c[0][k] + c[1][i] * c[1][k] + c[2][i] * c[2][k];
  const double mean = (g[0][0] + g[1][1] + g[2][2]) / 3, off = g[0][1] * g[0][1] + g[1][2] * g[1][2] + g[2][0] * g[2][0];
  const double x = g[0][0] - mean, y = g[1][1] - mean, z = g[2][2] - mean;
  const double spread = std::sqrt((x * x + y * y + z * z + 2 * off) / 6);
  double high = mean, low = mean;
  if (spread > 1e-15 * mean) {
    const double determinant = x * (y * z - g[1][2] * g[1][2]) - g[0][1] * (g[0][1] * z - g[1][2] * g[2][0]) +
                               g[2][0] * (g[0][1] * g[1][2] - y * g[2][0]);
    const double angle = std::acos(std::clamp(determinant / (2 * spread * spread * spread), -1.0, 1.0)) / 3;
    high = mean + 2 * spread * std::cos(angle);
    low = mean + 2 * spread * std::cos(angle + 2 * M_PI / 3);
  }
  const double least = 1e-20 * high, middle = 3 * mean - high - low;
  return 4 * M_PI * scale * scale * carlson_g(std::max(low, least), std::max(middle, least), high);
}

}  // namespace etendue
