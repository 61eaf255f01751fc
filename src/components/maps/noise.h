#pragma once
// Gradient noise, and the fractal sums made of it (Perlin 1985, "An image synthesizer"; Perlin 2002, "Improving noise").

#include <cstdint>

#include "etendue/core/vector.h"

namespace etendue {

/// Perlin's improved noise of 2002: about one feature per unit, in [-1.04, 1.04], with mean 0, two continuous
/// derivatives, and 0 where all coordinates are integers. 0 beyond a thousand million units and for what is no number.
float perlin_noise(const Vector3&, std::uint32_t seed = 0);

/// 32 random bits for a lattice point.
std::uint32_t lattice_hash(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed);

/// What averaging over a width, in units of the features, leaves of noise: the best estimate of a square's mean from the value
/// in its middle is that value times this, to 0.1 (measured: 0.87 for 1/2, 0.59 for 1, 0.16 for 2). From 2.9 on it is 0.
inline float noise_remains(float width) {
  const float left = 1 - width * width / 8;
  return left > 0 ? square(square(left)) : 0;
}

/// What averaging over a width leaves of a wave that is 1 long.
inline float wave_remains(float width) {
  if (width >= 1) return 0;
  const float x = pi * width;
  return x < 1e-2f ? 1 - x * x / 6 : std::sin(x) / x;
}

/// A sum of noise at growing frequencies. Octaves that the footprint does not resolve fade into their means.
struct Octaves {
  int count = 8;
  float lacunarity = 2;  ///< frequency of an octave over that of the one before
  float gain = 0.5f;     ///< amplitude of an octave over that of the one before
  std::uint32_t seed = 0;

  /// The mean of |noise|, measured over 2e7 points; of it averaging leaves what it leaves of noise this much finer.
  static constexpr float mean_absolute = 0.2202f, absolute_is_finer = 1.4f;

  /// Fractional Brownian motion: sum gain^i noise(lacunarity^i p) / sum gain^i; mean 0, in [-1, 1].
  float fbm(const Vector3& p, float width) const;
  /// Perlin's turbulence: sum gain^i |noise(lacunarity^i p)| / sum gain^i; in [0, 1].
  float turbulence(const Vector3& p, float width) const;

 private:
  template <class Value>
  float sum(const Vector3& p, float width, float mean, Value value) const;
};

}  // namespace etendue
