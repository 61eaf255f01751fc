#pragma once
// Functions of numbers with the language's rules at the edge of their domains, for float and Dual<float>.

#include <algorithm>
#include <cmath>
#include <limits>

#include "osl/values/dual.h"

namespace etendue::osl {

/// Lets a plain number and a Dual be computed by one formula: F::value(x), and F::slope(x, value) for the derivative.
template <class F>
float smooth(float x) {
  return F::value(x);
}
template <class F>
Dual<float> smooth(const Dual<float>& x) {
  const float value = F::value(x.value);
  return chain(value, F::slope(x.value, value), x);
}

inline float sqrt_or_zero(float x) { return x > 0 ? std::sqrt(x) : 0; }
inline float inversesqrt_or_zero(float x) { return x > 0 ? 1 / std::sqrt(x) : 0; }

inline Dual<float> sqrt_or_zero(const Dual<float>& x) {
  const float root = sqrt_or_zero(x.value);
  return chain(root, root > 0 ? 0.5f / root : 0, x);
}

/// x^y; 0 where it is not defined, and clamped to finite numbers. 0^0 = 1, 0^y = 0.
inline float safe_pow(float x, float y) {
  if (y == 0) return 1;
  if (x == 0) return 0;
  if (x < 0 && y != std::floor(y)) return 0;
  constexpr float largest = std::numeric_limits<float>::max();
  return std::clamp(std::pow(x, y), -largest, largest);
}
/// d(x^y) = y x^(y-1) dx + x^y log(x) dy.
inline Dual<float> safe_pow(const Dual<float>& x, const Dual<float>& y) {
  const float value = safe_pow(x.value, y.value);
  return chain(value, y.value * safe_pow(x.value, y.value - 1), x, x.value > 0 ? value * std::log(x.value) : 0, y);
}

/// The logarithm; of what is not positive that of the smallest normal number.
inline float safe_log(float x) { return std::log(std::max(x, std::numeric_limits<float>::min())); }

/// The remainder of a / b with the sign of a, 0 if b is 0.
inline float safe_fmod(float a, float b) { return b == 0 ? 0 : std::fmod(a, b); }
/// d(a - b n) with n, the truncated quotient, constant.
inline Dual<float> safe_fmod(const Dual<float>& a, const Dual<float>& b) {
  const float n = b.value == 0 ? 0 : std::trunc(a.value / b.value);
  return {safe_fmod(a.value, b.value), a.dx - b.dx * n, a.dy - b.dy * n};
}

/// a - b floor(a / b), a if b is 0.
inline float floor_mod(float a, float b) { return b == 0 ? a : a - b * std::floor(a / b); }
inline Dual<float> floor_mod(const Dual<float>& a, const Dual<float>& b) {
  const float n = b.value == 0 ? 0 : std::floor(a.value / b.value);
  return {a.value - b.value * n, a.dx - b.dx * n, a.dy - b.dy * n};
}

// Of equal numbers, minimum takes the first and maximum the second, with its derivatives, as the reference implementation does.
template <class N>
N minimum(const N& a, const N& b) {
  return value_of(a) <= value_of(b) ? a : b;
}
template <class N>
N maximum(const N& a, const N& b) {
  return value_of(a) > value_of(b) ? a : b;
}
template <class N>
N clamped(const N& x, const N& low, const N& high) {
  return maximum(minimum(x, high), low);
}

/// The unit vector, zero for zero.
inline Triple normalized(const Triple& v) { return v / Triple(length(v)); }
inline Dual<float> length(const Dual<Triple>& v) { return sqrt_or_zero(dot(v, v)); }
inline Dual<Triple> normalized(const Dual<Triple>& v) {
  const Dual<float> size = length(v);
  return v / make_triple(size, size, size);
}

}  // namespace etendue::osl
