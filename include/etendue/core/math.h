#pragma once
// Scalars: constants and the few functions that <cmath> lacks.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace etendue {

inline constexpr float pi = 3.14159265358979323846f;
inline constexpr float inverse_pi = 0.31830988618379067154f;
inline constexpr float infinity = std::numeric_limits<float>::infinity();

/// The largest float below 1: random numbers are clamped to it.
inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;

constexpr float square(float x) { return x * x; }

constexpr float lerp(float t, float a, float b) { return (1 - t) * a + t * b; }

constexpr float clamp(float x, float low, float high) { return x < low ? low : (x > high ? high : x); }

/// sqrt(max(x, 0)): for quantities that are negative only by rounding.
inline float safe_sqrt(float x) { return std::sqrt(std::max(x, 0.0f)); }

/// 1/sqrt(x) to about two units in the last place. The processor's estimate with a step of Newton's method takes little more
/// than half the time of a square root followed by a division.
inline float inverse_sqrt(float x) {
#if defined(__AVX512F__)
  if (!(x > 1e-30f && x < 1e30f)) [[unlikely]]  // zero and others for which the Newton step gives NaN
    return 1 / std::sqrt(x);
  const __m128 wide = _mm_set_ss(x);
  const float y = _mm_cvtss_f32(_mm_rsqrt14_ss(wide, wide));
  return y * (1.5f - (0.5f * x) * (y * y));
#else
  return 1 / std::sqrt(x);
#endif
}

inline float safe_acos(float x) { return std::acos(clamp(x, -1, 1)); }

inline float safe_asin(float x) { return std::asin(clamp(x, -1, 1)); }

/// c ? a : b without a branch.
constexpr float select(bool c, float a, float b) {
  const std::uint32_t mask = 0u - std::uint32_t(c), x = std::bit_cast<std::uint32_t>(a), y = std::bit_cast<std::uint32_t>(b);
  return std::bit_cast<float>((x & mask) | (y & ~mask));
}

constexpr float radians(float degrees) { return degrees * (pi / 180); }

constexpr float degrees(float radians) { return radians * (180 / pi); }

/// Upper bound of the relative error after n floating-point operations (Higham 2002, section 3.1).
constexpr float rounding_bound(int n) {
  constexpr float half_epsilon = std::numeric_limits<float>::epsilon() / 2;
  return (float(n) * half_epsilon) / (1 - float(n) * half_epsilon);
}

/// a*b - c*d without cancellation (Kahan's algorithm with fused multiply-add).
inline float difference_of_products(float a, float b, float c, float d) {
  const float cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

/// Sine and cosine of (pi/4) t for t in [-1, 1], to about 1e-7: minimax polynomials (coefficients of S. Moshier's Cephes
/// library, sinf.c). Without range reduction and without a call, as sampling a direction uses it for every sample.
inline void sin_cos_eighth(float t, float& sine, float& cosine) {
  const float x = (pi / 4) * t, z = x * x;
  sine = x + x * z * (-1.6666654611e-1f + z * (8.3321608736e-3f + z * -1.9515295891e-4f));
  cosine = 1 - 0.5f * z + z * z * (4.166664568298827e-2f + z * (-1.388731625493765e-3f + z * 2.443315711809948e-5f));
}

/// Sine and cosine of 2 pi u for u in [0, 1], to about 1e-7.
inline void sin_cos_turn(float u, float& sine, float& cosine) {
  const float quarter = float(int(4 * u + 0.5f));  // the nearest multiple of a quarter turn
  float s = 0, c = 0;
  sin_cos_eighth(2 * (4 * u - quarter), s, c);
  const int k = int(quarter);
  sine = (k & 1) ? c : s;
  cosine = (k & 1) ? s : c;
  if (k & 2) sine = -sine;
  if ((k + 1) & 2) cosine = -cosine;
}

/// A hash of 64 bits to 64 bits (the finaliser of splitmix64, Steele et al. 2014).
constexpr std::uint64_t mix_bits(std::uint64_t v) {
  v ^= v >> 30;
  v *= 0xbf58476d1ce4e5b9ull;
  v ^= v >> 27;
  v *= 0x94d049bb133111ebull;
  v ^= v >> 31;
  return v;
}

/// 32 random bits as a float in [0, 1).
constexpr float to_unit_float(std::uint32_t bits) { return float(bits >> 8) * 0x1p-24f; }

}  // namespace etendue
