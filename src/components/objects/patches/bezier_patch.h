#pragma once
// Rational Bézier patches of any degree: evaluation, derivatives and subdivision.

#include <array>
#include <cmath>
#include <vector>

namespace etendue::bezier {

/// A vector in double, as the root finder needs.
struct Vector {
  double x = 0, y = 0, z = 0;
};
inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(double f, const Vector& a) { return {f * a.x, f * a.y, f * a.z}; }
inline double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(const Vector& a) { return std::sqrt(dot(a, a)); }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A homogeneous control point (w x, w y, w z, w).
typedef double Control __attribute__((vector_size(32)));
inline Control control(const Vector& p, double weight) { return Control{weight * p.x, weight * p.y, weight * p.z, weight}; }
inline Vector position(const Control& c) { return {c[0] / c[3], c[1] / c[3], c[2] / c[3]}; }

constexpr int highest_degree = 9;
constexpr int most_points = (highest_degree + 1) * (highest_degree + 1);

/// S(s, t) = sum B_i(s) B_j(t) w_ij P_ij / sum B_i(s) B_j(t) w_ij for s and t from 0 to 1. The weights are positive.
struct Patch {
  int m = 3, n = 3;                    ///< degrees along s and t
  bool rational = false;               ///< whether the weights differ
  std::vector<Control> points;         ///< (m + 1) (n + 1) control points, s varying fastest
  double low[2]{0, 0}, high[2]{1, 1};  ///< surface coordinates at (0, 0) and (1, 1)
  bool flipped = false;                ///< the front is where -(S_s x S_t) points
  double size = 0;                     ///< upper bound of the distance of its points from the origin plus its extent
};

struct Derivatives {
  Vector position, ds, dt;
};
Derivatives evaluate(const Patch&, double s, double t);

/// The unit normal along S_s x S_t. Where this vanishes, as at a degenerate edge, the limit of the normal coming from the
/// middle of the patch.
Vector normal(const Patch&, double s, double t, const Derivatives&);

/// Sets `size`. Returns false if the control points lie on a line, so that the patch has no area.
bool measure(Patch&);

/// Values of the Bernstein polynomials of a degree and their derivatives, at x.
void bernstein(int degree, double x, double* values, double* derivatives);

/// Splits a net of control values of any kind, along s or t, into [0, at] and [at, 1] by de Casteljau's
/// scheme. `lower` or `upper` may be the net itself.
template <class T>
void split(int m, int n, bool along_s, double at, const T* net, T* lower, T* upper) {
  const int count = along_s ? m : n, step = along_s ? 1 : m + 1, lines = along_s ? n + 1 : m + 1, next = along_s ? m + 1 : 1;
  for (int line = 0; line < lines; ++line) {
    const int base = line * next;
    T work[highest_degree + 1];
    for (int i = 0; i <= count; ++i) work[i] = net[base + i * step];
    for (int r = 0; r <= count; ++r) {
      lower[base + r * step] = work[0];
      upper[base + (count - r) * step] = work[count - r];
      for (int i = 0; i < count - r; ++i) work[i] = (1 - at) * work[i] + at * work[i + 1];
    }
  }
}

}  // namespace etendue::bezier
