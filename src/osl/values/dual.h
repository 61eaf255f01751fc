#pragma once
// Dual: a value with its derivatives with respect to the picture's x and y (automatic differentiation in forward mode; Piponi
// 2004, "Automatic differentiation, C++ templates and photogrammetry").
//
// Functions of the library are templates over the number, float or Dual<float>, so that each formula is written once. A dual
// triple is Dual<Triple>, three blocks as in memory (type.h).

#include <cmath>

#include "triple.h"

namespace etendue::osl {

template <class T>
struct Dual {
  T value{}, dx{}, dy{};

  constexpr Dual() = default;
  constexpr Dual(const T& v) : value(v) {}  // NOLINT: a constant has zero derivatives
  constexpr Dual(const T& v, const T& x, const T& y) : value(v), dx(x), dy(y) {}
  Dual<float> operator[](int i) const { return {value[i], dx[i], dy[i]}; }
};

/// f(u) with df/du = slope: the chain rule.
inline Dual<float> chain(float value, float slope, const Dual<float>& u) { return {value, slope * u.dx, slope * u.dy}; }
/// f(u, v) with its two partial derivatives.
inline Dual<float> chain(float value, float by_u, const Dual<float>& u, float by_v, const Dual<float>& v) {
  return {value, by_u * u.dx + by_v * v.dx, by_u * u.dy + by_v * v.dy};
}

template <class T>
Dual<T> operator+(const Dual<T>& a, const Dual<T>& b) {
  return {a.value + b.value, a.dx + b.dx, a.dy + b.dy};
}
template <class T>
Dual<T> operator-(const Dual<T>& a, const Dual<T>& b) {
  return {a.value - b.value, a.dx - b.dx, a.dy - b.dy};
}
template <class T>
Dual<T> operator-(const Dual<T>& a) {
  return {-a.value, -a.dx, -a.dy};
}
template <class T>
Dual<T> operator*(const Dual<T>& a, const Dual<T>& b) {
  return {a.value * b.value, a.dx * b.value + a.value * b.dx, a.dy * b.value + a.value * b.dy};
}
/// Zero, with zero derivatives, where b is zero.
inline Dual<float> operator/(const Dual<float>& a, const Dual<float>& b) {
  if (b.value == 0) return {};
  const float inverse = 1 / b.value, value = a.value * inverse;
  return {a.value / b.value, inverse * (a.dx - value * b.dx), inverse * (a.dy - value * b.dy)};
}
inline Dual<Triple> operator/(const Dual<Triple>& a, const Dual<Triple>& b) {
  Dual<Triple> r;
  for (int i = 0; i < 3; ++i) {
    const Dual<float> q = a[i] / b[i];
    r.value[i] = q.value, r.dx[i] = q.dx, r.dy[i] = q.dy;
  }
  return r;
}
inline Dual<Triple> operator*(const Dual<float>& s, const Dual<Triple>& a) {
  return {s.value * a.value, s.dx * a.value + s.value * a.dx, s.dy * a.value + s.value * a.dy};
}
inline Dual<Triple> operator*(const Dual<Triple>& a, const Dual<float>& s) { return s * a; }

inline Dual<float> dot(const Dual<Triple>& a, const Dual<Triple>& b) {
  return {dot(a.value, b.value), dot(a.dx, b.value) + dot(a.value, b.dx), dot(a.dy, b.value) + dot(a.value, b.dy)};
}
inline Dual<Triple> cross(const Dual<Triple>& a, const Dual<Triple>& b) {
  return {cross(a.value, b.value), cross(a.dx, b.value) + cross(a.value, b.dx), cross(a.dy, b.value) + cross(a.value, b.dy)};
}

/// The triple of three numbers, of which each may be dual.
inline Triple make_triple(float x, float y, float z) { return {x, y, z}; }
inline Dual<Triple> make_triple(const Dual<float>& x, const Dual<float>& y, const Dual<float>& z) {
  return {{x.value, y.value, z.value}, {x.dx, y.dx, z.dx}, {x.dy, y.dy, z.dy}};
}

/// The value without derivatives, of either kind of number.
template <class T>
constexpr const T& value_of(const T& v) {
  return v;
}
template <class T>
constexpr const T& value_of(const Dual<T>& v) {
  return v.value;
}

template <class T>
inline constexpr bool is_dual = false;
template <class T>
inline constexpr bool is_dual<Dual<T>> = true;

}  // namespace etendue::osl
