#pragma once
// SIMD vectors of eight floats. Comparisons return one bit per lane; a comparison with NaN is false.

#include <bit>
#include <cmath>
#include <cstdint>

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace etendue {

inline constexpr int lanes = 8;
using Floats = float __attribute__((vector_size(lanes * sizeof(float))));
/// Lane i of a comparison is bit i.
using LaneBits = unsigned;

/// The same number in all lanes. (Subtracting zero changes no value, so compilers remove it; adding zero would turn -0 into 0.)
inline Floats spread(float x) { return x - Floats{}; }

#if defined(__AVX__)

inline __m256 raw(Floats a) { return std::bit_cast<__m256>(a); }
inline Floats lanes_of(__m256 a) { return std::bit_cast<Floats>(a); }

template <int predicate>
inline LaneBits compare(Floats a, Floats b) {
#if defined(__AVX512VL__)
  return _mm256_cmp_ps_mask(raw(a), raw(b), predicate);
#else
  return LaneBits(_mm256_movemask_ps(_mm256_cmp_ps(raw(a), raw(b), predicate)));
#endif
}
inline LaneBits less(Floats a, Floats b) { return compare<_CMP_LT_OQ>(a, b); }
inline LaneBits at_most(Floats a, Floats b) { return compare<_CMP_LE_OQ>(a, b); }

/// Minimum and maximum per lane; b where a is NaN.
inline Floats smaller(Floats a, Floats b) { return lanes_of(_mm256_min_ps(raw(a), raw(b))); }
inline Floats larger(Floats a, Floats b) { return lanes_of(_mm256_max_ps(raw(a), raw(b))); }

#else

inline LaneBits less(Floats a, Floats b) {
  LaneBits bits = 0;
  for (int i = 0; i < lanes; ++i) bits |= LaneBits(a[i] < b[i]) << i;
  return bits;
}
inline LaneBits at_most(Floats a, Floats b) {
  LaneBits bits = 0;
  for (int i = 0; i < lanes; ++i) bits |= LaneBits(a[i] <= b[i]) << i;
  return bits;
}
inline Floats smaller(Floats a, Floats b) { return a < b ? a : b; }
inline Floats larger(Floats a, Floats b) { return a > b ? a : b; }

#endif

inline double smaller(double a, double b) { return a < b ? a : b; }
inline double larger(double a, double b) { return a > b ? a : b; }

// a b - c d with the sign that the exact value has (or zero): with fused operations the error is at most 1.5 units in the last
// place (Kahan; Jeannerod, Louvet & Muller 2013), so the sign cannot be wrong. Without fused operations each product is rounded
// separately; rounding is monotonic, so the difference of two unequal products may become zero but cannot change its sign.
#if defined(__FMA__)
inline Floats signed_difference(Floats a, Floats b, Floats c, Floats d) {
  const __m256 cd = _mm256_mul_ps(raw(c), raw(d));
  return lanes_of(_mm256_add_ps(_mm256_fmsub_ps(raw(a), raw(b), cd), _mm256_fnmadd_ps(raw(c), raw(d), cd)));
}
inline double signed_difference(double a, double b, double c, double d) {
  const double cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}
/// a - b c
inline Floats minus_product(Floats a, Floats b, Floats c) { return lanes_of(_mm256_fnmadd_ps(raw(b), raw(c), raw(a))); }
inline double minus_product(double a, double b, double c) { return std::fma(-b, c, a); }
#else
inline Floats signed_difference(Floats a, Floats b, Floats c, Floats d) { return a * b - c * d; }
inline double signed_difference(double a, double b, double c, double d) { return a * b - c * d; }
inline Floats minus_product(Floats a, Floats b, Floats c) { return a - b * c; }
inline double minus_product(double a, double b, double c) { return a - b * c; }
#endif

}  // namespace etendue
