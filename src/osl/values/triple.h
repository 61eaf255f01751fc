#pragma once
// Triple and Matrix: what color, point, vector and normal, and matrix are in memory, with their arithmetic.
//
// As in the language, all operations of triples work component by component, and division by zero gives zero.

#include <cmath>

namespace etendue::osl {

struct Triple {
  float x = 0, y = 0, z = 0;

  constexpr Triple() = default;
  constexpr Triple(float all) : x(all), y(all), z(all) {}  // NOLINT: as in the language, a number is a triple of it
  constexpr Triple(float x_, float y_, float z_) : x(x_), y(y_), z(z_) {}
  constexpr float operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }
  constexpr float& operator[](int i) { return i == 0 ? x : (i == 1 ? y : z); }
  bool operator==(const Triple&) const = default;
};

/// a / b, or 0 if b is 0.
constexpr float safe_divide(float a, float b) { return b != 0 ? a / b : 0; }

constexpr Triple operator+(const Triple& a, const Triple& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Triple operator-(const Triple& a, const Triple& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Triple operator*(const Triple& a, const Triple& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
constexpr Triple operator*(const Triple& a, float s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr Triple operator*(float s, const Triple& a) { return a * s; }
constexpr Triple operator-(const Triple& a) { return {-a.x, -a.y, -a.z}; }
constexpr Triple& operator+=(Triple& a, const Triple& b) { return a = a + b; }
constexpr Triple operator/(const Triple& a, const Triple& b) {
  return {safe_divide(a.x, b.x), safe_divide(a.y, b.y), safe_divide(a.z, b.z)};
}
constexpr float dot(const Triple& a, const Triple& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Triple cross(const Triple& a, const Triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(const Triple& a) { return std::sqrt(dot(a, a)); }

/// A 4x4 matrix as shaders know it: points are rows, p' = p M, so that the translation is the last row.
struct Matrix {
  float m[4][4] = {};

  /// `s` in the diagonal, zero elsewhere.
  static constexpr Matrix diagonal(float s) {
    Matrix r;
    for (int i = 0; i < 4; ++i) r.m[i][i] = s;
    return r;
  }
  static constexpr Matrix identity() { return diagonal(1); }
  bool operator==(const Matrix&) const = default;
};

/// First a, then b, for rows: p (a b) = (p a) b.
Matrix operator*(const Matrix& a, const Matrix& b);
Matrix operator*(const Matrix& a, float s);
/// a times the inverse of b; zero if b is singular.
Matrix operator/(const Matrix& a, const Matrix& b);
Matrix operator/(const Matrix& a, float s);
Matrix transpose(const Matrix&);
float determinant(const Matrix&);
/// Sets the inverse. Returns false, and sets the identity, if there is none.
bool invert(const Matrix&, Matrix& inverse);

/// (x y z 1) M, divided by its fourth component (zero if that is zero).
Triple transform_point(const Matrix&, const Triple&);
/// (x y z 0) M.
Triple transform_vector(const Matrix&, const Triple&);
/// (x y z 0) times the transposed inverse of M.
Triple transform_normal(const Matrix&, const Triple&);

}  // namespace etendue::osl
