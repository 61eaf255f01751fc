#include "sigmoid_fit.h"

#include <algorithm>

#include "etendue/describe/color.h"
#include "tables.h"

namespace etendue {

Coefficients flat_coefficients(double value) {
  // x = (2v - 1) / (2 sqrt(v (1 - v))) inverts S; at both ends a number so large that S rounds to 0 and 1.
  constexpr double end = 1e9;
  if (!(value > 0)) return {0, 0, -end};
  if (value >= 1) return {0, 0, end};
  return {0, 0, std::clamp((value - 0.5) / std::sqrt(value * (1 - value)), -end, end)};
}

double evaluate_sigmoid(const Coefficients& c, double wavelength) {
  const double t = sigmoid_variable(wavelength);
  return sigmoid((c[0] * t + c[1]) * t + c[2]);
}

Spectrum evaluate_sigmoid(float c0, float c1, float c2, const Wavelengths& wavelengths) {
  detail::Lanes result{};
  for (int i = 0; i < spectrum_size; ++i) {
    const float t = (wavelengths[i] - 595.0f) * float(1 / 235.0);
    const float x = (c0 * t + c1) * t + c2;
    result[i] = 0.5f + 0.5f * x / std::sqrt(1 + x * x);
  }
  return Spectrum(result);
}

SigmoidFit::SigmoidFit(const RgbSpace& space, int step) {
  const int intervals = (tables::size - 1 + step - 1) / step;
  nodes_ = (intervals + 1 + 3) / 4 * 4;
  variable_.assign(size_t(nodes_), 0.0);
  for (auto& w : weight_) w.assign(size_t(nodes_), 0.0);
  for (int i = 0; i < nodes_; ++i) variable_[size_t(i)] = sigmoid_variable(wavelength_low + double(i * step));

  for (int k = 0; k < tables::size; ++k) {
    const double power = double(space.illuminant->at(wavelength_low + float(k), ColorUse::radiance));
    const double* xyz = tables::observer[k];
    const int node = k / step;
    const double fraction = double(k - node * step) / step;
    for (int row = 0; row < 3; ++row) {
      const double* m = &space.from_xyz[size_t(3 * row)];
      const double w = power * (m[0] * xyz[0] + m[1] * xyz[1] + m[2] * xyz[2]);
      weight_[size_t(row)][size_t(node)] += w * (1 - fraction);
      if (fraction > 0) weight_[size_t(row)][size_t(node + 1)] += w * fraction;
    }
  }
  // A perfect white is (1, 1, 1) exactly, although tabulated illuminants miss the nominal white by 1e-4.
  for (auto& weights : weight_) {
    double sum = 0;
    for (const double w : weights) sum += w;
    for (double& w : weights) w /= sum;
  }
}

void SigmoidFit::evaluate(const Coefficients& c, Point& point) const {
  using Lanes = double __attribute__((vector_size(32)));
  Lanes value[3] = {}, derivative[9] = {};
  const auto load = [](const double* from) {
    Lanes v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
  };
  for (int i = 0; i < nodes_; i += 4) {
    const Lanes t = load(&variable_[size_t(i)]);
    const Lanes x = (c[0] * t + c[1]) * t + c[2];
    const Lanes square = 1 + x * x;
    Lanes root;
    for (int j = 0; j < 4; ++j) root[j] = std::sqrt(square[j]);
    const Lanes inverse = 0.5 / root;
    const Lanes s = 0.5 + x * inverse, ds = inverse / square, dst = ds * t, dstt = dst * t;
    for (int row = 0; row < 3; ++row) {
      const Lanes w = load(&weight_[size_t(row)][size_t(i)]);
      value[row] += w * s;
      derivative[3 * row] += w * dstt;
      derivative[3 * row + 1] += w * dst;
      derivative[3 * row + 2] += w * ds;
    }
  }
  const auto sum = [](const Lanes& v) { return (v[0] + v[1]) + (v[2] + v[3]); };
  for (int i = 0; i < 3; ++i) point.rgb[size_t(i)] = sum(value[i]);
  for (int i = 0; i < 9; ++i) point.derivative[size_t(i)] = sum(derivative[i]);
}

std::array<double, 3> SigmoidFit::rgb_of(const Coefficients& c) const {
  Point point;
  evaluate(c, point);
  return point.rgb;
}

namespace {

double largest(const std::array<double, 3>& v) { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); }

/// Solves the symmetric positive definite system a d = b by Cholesky's decomposition; false when it is not definite.
bool solve_definite(const double a[3][3], const double b[3], double d[3]) {
  double l[3][3] = {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      if (i == j) {
        if (!(sum > 0)) return false;
        l[i][i] = std::sqrt(sum);
      } else {
        l[i][j] = sum / l[j][j];
      }
    }
  double y[3];
  for (int i = 0; i < 3; ++i) {
    y[i] = b[i];
    for (int k = 0; k < i; ++k) y[i] -= l[i][k] * y[k];
    y[i] /= l[i][i];
  }
  for (int i = 2; i >= 0; --i) {
    d[i] = y[i];
    for (int k = i + 1; k < 3; ++k) d[i] -= l[k][i] * d[k];
    d[i] /= l[i][i];
  }
  return true;
}

}  // namespace

double SigmoidFit::solve(const std::array<double, 3>& rgb, Coefficients& c, double tolerance, int iterations) const {
  // Gauss-Newton with Marquardt's damping: (J^T J + damping diag(J^T J)) step = J^T (rgb - f(c)).
  constexpr double bound = 300;  // limits slopes to a few nanometres; steeper ones change no colour by 1e-4
  Point point, trial;
  evaluate(c, point);
  const auto residual = [&](const Point& p) { return std::array{rgb[0] - p.rgb[0], rgb[1] - p.rgb[1], rgb[2] - p.rgb[2]}; };
  const auto squares = [](const std::array<double, 3>& r) { return r[0] * r[0] + r[1] * r[1] + r[2] * r[2]; };
  std::array<double, 3> r = residual(point);
  double damping = 0;
  for (int iteration = 0; iteration < iterations && largest(r) > tolerance; ++iteration) {
    double a[3][3], b[3];
    const auto& j = point.derivative;
    for (size_t row = 0; row < 3; ++row) {
      for (size_t column = 0; column < 3; ++column)
        a[row][column] = j[row] * j[column] + j[3 + row] * j[3 + column] + j[6 + row] * j[6 + column];
      b[row] = j[row] * r[0] + j[3 + row] * r[1] + j[6 + row] * r[2];
    }
    for (int i = 0; i < 3; ++i) a[i][i] *= 1 + damping;
    double step[3];
    bool better = false;
    if (solve_definite(a, b, step)) {
      Coefficients next;
      for (size_t i = 0; i < 3; ++i) next[i] = std::clamp(c[i] + step[i], -bound, bound);
      evaluate(next, trial);
      const auto next_r = residual(trial);
      if (squares(next_r) < squares(r)) {
        better = true;
        c = next;
        point = trial;
        r = next_r;
      }
    }
    damping = better ? (damping > 1e-9 ? damping * 0.1 : 0) : std::max(damping * 8, 1e-4);
    if (damping > 1e12) break;
  }
  return largest(r);
}

Coefficients SigmoidFit::solve(const std::array<double, 3>& rgb) const {
  if (rgb[0] == rgb[1] && rgb[1] == rgb[2]) return flat_coefficients(rgb[0]);
  constexpr double tolerance = 1e-8;
  // Continuation from the grey of the same mean to the colour, with steps that are halved when a fit fails.
  const double mean = std::clamp((rgb[0] + rgb[1] + rgb[2]) / 3, 1e-6, 1 - 1e-6);
  Coefficients c = flat_coefficients(mean);
  double done = 0, step = 1;
  while (done < 1) {
    const double next = std::min(done + step, 1.0);
    std::array<double, 3> target;
    for (size_t i = 0; i < 3; ++i) target[i] = mean + next * (rgb[i] - mean);
    Coefficients attempt = c;
    const bool last_try = step < 1e-2;
    if (solve(target, attempt, tolerance, last_try ? 200 : 12) <= tolerance) {
      c = attempt;
      done = next;
      step *= 2;
    } else if (last_try) {
      // At or beyond the boundary of the colours that a reflectance can have.
      solve(rgb, c, tolerance, 300);
      return c;
    } else {
      step *= 0.5;
    }
  }
  return c;
}

}  // namespace etendue
