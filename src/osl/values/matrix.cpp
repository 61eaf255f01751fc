// Arithmetic of 4x4 matrices.

#include <cmath>
#include <utility>

#include "triple.h"

namespace etendue::osl {

Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix r;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      r.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j] + a.m[i][3] * b.m[3][j];
  return r;
}

Matrix operator*(const Matrix& a, float s) {
  Matrix r;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) r.m[i][j] = a.m[i][j] * s;
  return r;
}

Matrix operator/(const Matrix& a, float s) { return a * safe_divide(1, s); }

Matrix operator/(const Matrix& a, const Matrix& b) {
  Matrix inverse;
  return invert(b, inverse) ? a * inverse : Matrix{};
}

Matrix transpose(const Matrix& a) {
  Matrix r;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) r.m[j][i] = a.m[i][j];
  return r;
}

namespace {

/// Gaussian elimination with partial pivoting in double precision: brings `a` to the identity, and applies the same steps to
/// `with`. Returns the determinant of a, zero if it is singular (then both are left half way).
double eliminate(double (&a)[4][4], double (&with)[4][4]) {
  double product = 1;
  for (int column = 0; column < 4; ++column) {
    int pivot = column;
    for (int row = column + 1; row < 4; ++row)
      if (std::abs(a[row][column]) > std::abs(a[pivot][column])) pivot = row;
    if (!(std::abs(a[pivot][column]) > 0)) return 0;
    if (pivot != column) {
      std::swap(a[pivot], a[column]);
      std::swap(with[pivot], with[column]);
      product = -product;
    }
    const double scale = a[column][column];
    product *= scale;
    for (int j = 0; j < 4; ++j) a[column][j] /= scale, with[column][j] /= scale;
    for (int row = 0; row < 4; ++row) {
      const double factor = a[row][column];
      if (row == column || factor == 0) continue;
      for (int j = 0; j < 4; ++j) a[row][j] -= factor * a[column][j], with[row][j] -= factor * with[column][j];
    }
  }
  return product;
}

double eliminate(const Matrix& m, double (&inverse)[4][4]) {
  double a[4][4];
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) a[i][j] = double(m.m[i][j]), inverse[i][j] = i == j ? 1 : 0;
  return eliminate(a, inverse);
}

}  // namespace

float determinant(const Matrix& m) {
  double inverse[4][4];
  return float(eliminate(m, inverse));
}

bool invert(const Matrix& m, Matrix& to) {
  double inverse[4][4];
  const double d = eliminate(m, inverse);
  if (d == 0 || !std::isfinite(d)) {
    to = Matrix::identity();
    return false;
  }
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) to.m[i][j] = float(inverse[i][j]);
  return true;
}

Triple transform_point(const Matrix& m, const Triple& p) {
  const auto column = [&](int j) { return p.x * m.m[0][j] + p.y * m.m[1][j] + p.z * m.m[2][j] + m.m[3][j]; };
  const float w = column(3);
  return w == 1 ? Triple(column(0), column(1), column(2)) : Triple(column(0), column(1), column(2)) / Triple(w);
}

Triple transform_vector(const Matrix& m, const Triple& v) {
  const auto column = [&](int j) { return v.x * m.m[0][j] + v.y * m.m[1][j] + v.z * m.m[2][j]; };
  return {column(0), column(1), column(2)};
}

Triple transform_normal(const Matrix& m, const Triple& n) {
  Matrix inverse;
  invert(m, inverse);
  return transform_vector(transpose(inverse), n);
}

}  // namespace etendue::osl
