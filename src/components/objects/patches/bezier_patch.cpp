#include "bezier_patch.h"

#include <algorithm>

namespace etendue::bezier {
namespace {

// Bernstein polynomials by the recurrence B_i^k = (1 - x) B_i^(k-1) + x B_(i-1)^(k-1), and B_i' = k (B_(i-1) - B_i)^(k-1).
template <class Degree>
void basis(Degree degree, double x, double* b, double* d) {
  const double y = 1 - x;
  b[0] = 1;
  for (int k = 1; k < degree; ++k) {
    b[k] = x * b[k - 1];
    for (int i = k - 1; i > 0; --i) b[i] = y * b[i] + x * b[i - 1];
    b[0] *= y;
  }
  d[0] = -degree * b[0];
  for (int i = 1; i < degree; ++i) d[i] = degree * (b[i - 1] - b[i]);
  d[degree] = degree * b[degree - 1];
  b[degree] = x * b[degree - 1];
  for (int i = degree - 1; i > 0; --i) b[i] = y * b[i] + x * b[i - 1];
  b[0] *= y;
}

struct Three {
  constexpr operator int() const { return 3; }
};

template <class M, class N>
Derivatives evaluate(const Patch& patch, M m, N n, double s, double t) {
  double bs[highest_degree + 1], ds[highest_degree + 1], bt[highest_degree + 1], dt[highest_degree + 1];
  basis(m, s, bs, ds);
  basis(n, t, bt, dt);
  Control value{}, along_s{}, along_t{};
  const Control* p = patch.points.data();
  for (int j = 0; j <= n; ++j) {
    Control row{}, slope{};
    for (int i = 0; i <= m; ++i, ++p) {
      row += bs[i] * *p;
      slope += ds[i] * *p;
    }
    value += bt[j] * row;
    along_s += bt[j] * slope;
    along_t += dt[j] * row;
  }
  if (patch.rational) {  // (A / w)' = (A' - w' A / w) / w
    const double inverse = 1 / value[3];
    value *= inverse;
    along_s = inverse * (along_s - along_s[3] * value);
    along_t = inverse * (along_t - along_t[3] * value);
  }
  return {{value[0], value[1], value[2]}, {along_s[0], along_s[1], along_s[2]}, {along_t[0], along_t[1], along_t[2]}};
}

}  // namespace

Derivatives evaluate(const Patch& patch, double s, double t) {
  return patch.m == 3 && patch.n == 3 ? evaluate(patch, Three{}, Three{}, s, t) : evaluate(patch, patch.m, patch.n, s, t);
}

bool measure(Patch& patch) {
  const Vector first = position(patch.points.front());
  Vector longest;
  double extent = 0;
  patch.size = 0;
  for (const Control& c : patch.points) {
    const Vector p = position(c), from = p - first;
    patch.size = std::max(patch.size, length(p));
    if (length(from) > extent) longest = from, extent = length(from);
  }
  patch.size += extent;
  double aside = 0;
  for (const Control& c : patch.points) aside = std::max(aside, length(cross(position(c) - first, longest)));
  return aside > 1e-7 * extent * extent && extent > 1e-12 * patch.size;
}

void bernstein(int degree, double x, double* values, double* derivatives) { basis(degree, x, values, derivatives); }

Vector normal(const Patch& patch, double s, double t, const Derivatives& at) {
  Derivatives d = at;
  // Steps towards the middle, which quickly leave any degenerate edge. A step of 1e-6 rotates the normal of a patch without
  // creases by about 1e-6 at most.
  for (double step = 1e-6; step < 1; step *= 10) {
    const Vector n = cross(d.ds, d.dt);
    const double l = length(n);
    if (l > 1e-9 * dot(d.ds, d.ds) && l > 1e-9 * dot(d.dt, d.dt) && l > 0) return (1 / l) * n;
    d = evaluate(patch, s + step * (0.5 - s), t + step * (0.5 - t));
  }
  return {0, 0, 1};
}

}  // namespace etendue::bezier
