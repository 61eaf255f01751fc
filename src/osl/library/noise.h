#pragma once
// Noises: functions of one to four coordinates, optionally periodic.

#include <array>
#include <cmath>

#include "osl/values/dual.h"
#include "osl/values/interned_string.h"

namespace etendue::osl {

inline constexpr int most_dimensions = 4;

/// A position: its coordinates and, for periodic noise, the periods.
template <class N>
struct Position {
  int dimensions = 0;
  std::array<N, most_dimensions> at{};
  bool periodic = false;
  std::array<float, most_dimensions> period{};
};

/// The whole period that is used: its floor, at least 1.
inline float whole_period(float period) { return std::max(std::floor(period), 1.0f); }

/// A coordinate in [0, period).
inline float wrapped(float x, float period) {
  period = whole_period(period);
  return x - period * std::floor(x / period);
}

/// A float's floor as an int, clamped to the ints.
inline int floor_to_int(float x) {
  const float f = std::floor(x);
  return f >= 2147483648.0f ? 2147483647 : (f >= -2147483648.0f ? int(f) : -2147483647 - 1);
}

// Each of the following gives `count` values, 1 or 3, to `out`.

/// Signed gradient noise in about [-1, 1] (Perlin 2002, "Improving Noise").
void perlin_noise(const Position<float>&, int count, float* out);
void perlin_noise(const Position<Dual<float>>&, int count, Dual<float>* out);
/// The same numbers, without periods.
float perlin_noise(float x);
float perlin_noise(float x, float y);
float perlin_noise(float x, float y, float z);
float perlin_noise(float x, float y, float z, float t);

/// Constant in unit cells, in [0, 1].
void cell_noise(const Position<float>&, int count, float* out);
/// A hash of the exact coordinates, in [0, 1].
void hash_noise(const Position<float>&, int count, float* out);

/// Signed simplex noise in about [-1, 1] (Gustavson 2005, "Simplex noise demystified"). Not periodic.
void simplex_noise(const Position<float>&, int count, float* out);
void simplex_noise(const Position<Dual<float>>&, int count, Dual<float>* out);

struct GaborOptions {
  int anisotropic = 0;
  Triple direction{1, 0, 0};
  float bandwidth = 1;
  float impulses = 16;
  bool filter = true;
};

/// Signed, filtered Gabor noise (Lagae, Lefebvre, Drettakis, Dutre 2009, "Procedural noise using sparse Gabor convolution";
/// Lagae and Drettakis 2011, "Filtering solid Gabor noise"). The fourth coordinate has no effect.
void gabor_noise(const Position<Dual<float>>&, const GaborOptions&, int count, Dual<float>* out);

}  // namespace etendue::osl
