#include "albedo_inversion.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "components/shaders/fresnel.h"
#include "etendue/core/math.h"

namespace etendue {
namespace {

// Radiance is represented at some cosines, and is the same at all azimuths. It is integrated by Gauss's rule in each of two
// ranges, which meet at the critical angle, where internal reflection changes abruptly.
constexpr int per_range = 6, size = 2 * per_range;
constexpr int moments = 2 * per_range;  // Legendre polynomials below this order are integrated exactly

struct Matrix {
  double m[size][size] = {};

  static Matrix identity() {
    Matrix r;
    for (int i = 0; i < size; ++i) r.m[i][i] = 1;
    return r;
  }
  friend Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix r;
    for (int i = 0; i < size; ++i)
      for (int k = 0; k < size; ++k)
        for (int j = 0; j < size; ++j) r.m[i][j] += a.m[i][k] * b.m[k][j];
    return r;
  }
  Matrix& add(const Matrix& b, double factor = 1) {
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j) m[i][j] += factor * b.m[i][j];
    return *this;
  }
  double largest() const {
    double x = 0;
    for (const auto& row : m)
      for (const double v : row) x = std::max(x, std::abs(v));
    return x;
  }
};

/// a^-1 b, by elimination; all matrices here are diagonally dominant.
Matrix solve(Matrix a, Matrix b) {
  for (int k = 0; k < size; ++k) {
    const double inverse = 1 / a.m[k][k];
    for (int j = 0; j < size; ++j) {
      a.m[k][j] *= inverse;
      b.m[k][j] *= inverse;
    }
    for (int i = 0; i < size; ++i) {
      const double factor = a.m[i][k];
      if (i == k || factor == 0) continue;
      for (int j = 0; j < size; ++j) {
        a.m[i][j] -= factor * a.m[k][j];
        b.m[i][j] -= factor * b.m[k][j];
      }
    }
  }
  return b;
}

struct Quadrature {
  double cosine[size], weight[size];

  explicit Quadrature(double border) {
    // Gauss-Legendre of six points on [-1, 1] (Abramowitz & Stegun 1964, table 25.4).
    constexpr double x[3] = {0.238619186083197, 0.661209386466265, 0.932469514203152};
    constexpr double w[3] = {0.467913934572691, 0.360761573048139, 0.171324492379170};
    const double ends[3] = {0, border, 1};
    for (int range = 0; range < 2; ++range)
      for (int i = 0; i < per_range; ++i) {
        const double at = (i % 2 ? 1 : -1) * x[i / 2], half = (ends[range + 1] - ends[range]) / 2;
        cosine[range * per_range + i] = ends[range] + half * (1 + at);
        weight[range * per_range + i] = half * w[i / 2];
      }
  }
};

/// The phase function averaged over azimuth, for light scattered into the same hemisphere (onward) and into the opposite one
/// (back): p = sum_l (2 l + 1) chi_l P_l(c) P_l(+-c'). A forward peak beyond these moments is treated as unscattered light
/// (Wiscombe 1977, "The delta-M method"): chi_l = (g^l - f) / (1 - f) with f = g^moments.
struct Redistribution {
  Matrix onward, back;
  double peak;

  Redistribution(const Quadrature& q, double g) : peak(std::pow(g, moments)) {
    double legendre[moments][size];
    for (int i = 0; i < size; ++i) {
      legendre[0][i] = 1;
      legendre[1][i] = q.cosine[i];
      for (int l = 2; l < moments; ++l)
        legendre[l][i] = ((2 * l - 1) * q.cosine[i] * legendre[l - 1][i] - (l - 1) * legendre[l - 2][i]) / l;
    }
    double moment = 1;
    for (int l = 0; l < moments; ++l, moment *= g) {
      const double chi = (2 * l + 1) * (moment - peak) / (1 - peak);
      for (int i = 0; i < size; ++i)
        for (int j = 0; j < size; ++j) {
          const double term = chi * legendre[l][i] * legendre[l][j];
          onward.m[i][j] += term;
          back.m[i][j] += l % 2 ? -term : term;
        }
    }
  }
};

/// The reflection of a half space, as a matrix from incident to reflected cosines, by doubling. The first, thin layer is
/// computed by the diamond scheme (Wiscombe 1976), which conserves energy exactly: with a = d/2 M^-1 (1 - w/2 P+ W) and b = d/2
/// M^-1 w/2 P- W, R = 2 G b (1 + a)^-1 and T = 2 G - 1 where G = (1 + a - b (1 + a)^-1 b)^-1. Two equal layers together have
/// the reflection R + T (1 - R R)^-1 R T and the transmission T (1 - R R)^-1 T.
Matrix half_space(const Quadrature& q, const Redistribution& p, double w) {
  w *= (1 - p.peak) / (1 - w * p.peak);
  constexpr double thickness = 1.0 / 1024;
  Matrix a, b;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      const double factor = thickness / 2 / q.cosine[i], scattered = w / 2 * q.weight[j];
      a.m[i][j] = factor * ((i == j ? 1 : 0) - scattered * p.onward.m[i][j]);
      b.m[i][j] = factor * scattered * p.back.m[i][j];
    }
  const Matrix one_and_a = Matrix::identity().add(a);
  Matrix d = one_and_a;
  d.add(b * solve(one_and_a, b), -1);
  const Matrix g = solve(d, Matrix::identity());
  Matrix r = g * b * solve(one_and_a, Matrix::identity()), t = Matrix().add(g, 2).add(Matrix::identity(), -1);
  for (double& x : std::span(&r.m[0][0], size * size)) x *= 2;

  for (int doubling = 0; doubling < 60 && t.largest() > 1e-7; ++doubling) {
    const Matrix between = solve(Matrix::identity().add(r * r, -1), t);  // (1 - R R)^-1 T
    const Matrix through = t * between;
    r.add(t * (r * between));
    t = through;
  }
  return r;
}

}  // namespace

AlbedoInversion::AlbedoInversion(double g, double eta) : g_(float(g)) {
  const Quadrature q(eta > 1.0001 ? std::sqrt(1 - 1 / (eta * eta)) : 0.5);
  const Redistribution p(q, g);
  double reflected[size];
  for (int i = 0; i < size; ++i) reflected[i] = eta == 1 ? 0 : double(fresnel_dielectric(float(q.cosine[i]), float(1 / eta)));

  returned_.front() = 1;
  for (int i = 1; i < intervals; ++i) {
    const double root = double(i) / intervals, s = root * root;
    const Matrix r = half_space(q, p, (1 - s * s) / (1 - g * s * s));
    // Radiance upwards below the boundary: u = R (1 + F u), so u = (1 - R F)^-1 R 1; of it (1 - F) u leaves.
    Matrix a = Matrix::identity(), ones;
    for (int k = 0; k < size; ++k)
      for (int j = 0; j < size; ++j) {
        a.m[k][j] -= r.m[k][j] * reflected[j];
        ones.m[k][0] += r.m[k][j];
      }
    const Matrix up = solve(a, ones);
    double leaves = 0;
    for (int k = 0; k < size; ++k) leaves += 2 * q.weight[k] * q.cosine[k] * (1 - reflected[k]) * up.m[k][0];
    returned_[size_t(i)] = std::min(float(leaves), returned_[size_t(i) - 1]);
  }
  returned_.back() = 0;
}

float AlbedoInversion::similarity(float returned) const {
  size_t low = 0, high = intervals;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    (returned_[middle] >= returned ? low : high) = middle;
  }
  const float step = returned_[low] - returned_[high];
  const float t = step > 0 ? clamp((returned_[low] - returned) / step, 0, 1) : 0;
  const float a = square(float(low) / intervals), b = square(float(high) / intervals);
  return lerp(t, a, b);
}

}  // namespace etendue
