#pragma once
// Finds the first sign change of a polynomial on an interval from its Bernstein coefficients.

#include <cmath>

namespace etendue::bernstein {

// f(s) = sum b_i C(n, i) s^i (1 - s)^(n - i) on [0, 1]. It has no more roots in (0, 1) than its coefficients have changes of
// sign, and the two counts differ by an even number (Descartes' rule): no sign change means no root, one sign change means one
// root. With more, de Casteljau's algorithm halves the interval, and few steps separate roots that are apart (Lane & Riesenfeld
// 1981, "Bounds on a polynomial"). Zero counts as positive throughout, so that between ends of different sign the number of
// changes is odd, and between ends of the same sign it is even.

template <int N>
int sign_changes(const double (&b)[N + 1]) {
  int changes = 0;
  for (int i = 0; i < N; ++i) changes += (b[i] < 0) != (b[i + 1] < 0);
  return changes;
}

/// Returns the value at s; `slope` receives the derivative.
template <int N>
double evaluate(const double (&b)[N + 1], double s, double& slope) {
  double c[N + 1];
  for (int i = 0; i <= N; ++i) c[i] = b[i];
  for (int level = N; level > 1; --level)
    for (int i = 0; i < level; ++i) c[i] += s * (c[i + 1] - c[i]);
  slope = N * (c[1] - c[0]);
  return c[0] + s * (c[1] - c[0]);
}

/// The root of a polynomial with one sign change between ends of different sign: Newton's method, with bisection where a step
/// leaves the bracket.
template <int N>
double only_root(const double (&b)[N + 1]) {
  const bool negative = b[0] < 0;
  double low = 0, high = 1, s = b[0] / (b[0] - b[N]);
  for (int i = 0; i < 64 && high - low > 1e-15; ++i) {
    double slope = 0;
    const double f = evaluate<N>(b, s, slope);
    if (f == 0) return s;
    ((f < 0) == negative ? low : high) = s;
    double next = s - f / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - s) <= 1e-16) return next;
    s = next;
  }
  return s;
}

/// The first s in [0, 1] behind which the sign differs from that at 0; returns false if there is none.
template <int N>
bool first_sign_change(const double (&b)[N + 1], double& s, double low = 0, double high = 1, int depth = 44) {
  const int changes = sign_changes<N>(b);
  if (changes == 0) return false;
  if (changes == 1) {
    s = low + (high - low) * only_root<N>(b);
    return true;
  }
  const double middle = 0.5 * (low + high);
  if (depth == 0) {  // a multiple root
    s = middle;
    return (b[0] < 0) != (b[N] < 0);
  }
  double left[N + 1], right[N + 1];
  for (int i = 0; i <= N; ++i) right[i] = b[i];
  for (int i = 0; i <= N; ++i) {
    left[i] = right[0];
    for (int k = 0; k < N - i; ++k) right[k] = 0.5 * (right[k] + right[k + 1]);
  }
  if (first_sign_change<N>(left, s, low, middle, depth - 1)) return true;
  if ((left[N] < 0) != (b[0] < 0)) {
    s = middle;
    return true;
  }
  return first_sign_change<N>(right, s, middle, high, depth - 1);
}

/// The first t in [from, to] behind which f is on the other side of 0 than `inside` says, for a polynomial over that range;
/// `inside` is then set to the new side. If rounding gives f at `from` a sign that contradicts `inside`, a crossing is returned
/// at `from`, so that crossings still alternate from piece to piece of a ray.
template <int N>
bool crosses(const double (&b)[N + 1], double from, double to, bool& inside, double& t) {
  double s = 0;
  if ((b[0] < 0) == inside && !first_sign_change<N>(b, s)) return false;
  inside = !inside;
  t = from + s * (to - from);
  return true;
}

}  // namespace etendue::bernstein
