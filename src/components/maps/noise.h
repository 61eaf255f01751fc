#pragma once
// Gradient noise, and fractal sums of it (Perlin 1985, "An image synthesizer"; Perlin 2002, "Improving noise").

#include <cstdint>

#include "etendue/core/vector.h"

namespace etendue {

/// Perlin's improved noise of 2002: about one feature per unit, in [-1.04, 1.04], with mean 0, two continuous
/// derivatives, and 0 where all coordinates are integers. Returns 0 beyond 1e9 units and for NaN.
float perlin_noise(const Vector3&, std::uint32_t seed = 0);

/// 32 random bits for a lattice point.
std::uint32_t lattice_hash(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed);

/// The factor by which averaging over a square of a given width, in units of the features, attenuates noise: the best estimate
/// of the square's mean from the value in its middle is this value times the factor. It agrees to 0.1 with the measured factors
/// (0.87 for 1/2, 0.59 for 1, 0.16 for 2), and is 0 from 2.9 on.
inline float noise_remains(float width) {
  const float left = 1 - width * width / 8;
  return left > 0 ? square(square(left)) : 0;
}

/// The factor by which averaging over a width attenuates a sine wave of wavelength 1: sin(pi w) / (pi w), 0 from w = 1 on.
inline float wave_remains(float width) {
  if (width >= 1) return 0;
  const float x = pi * width;
  return x < 1e-2f ? 1 - x * x / 6 : std::sin(x) / x;
}

/// A sum of noise at increasing frequencies. Octaves that are finer than the footprint fade to their means.
struct Octaves {
  int count = 8;
  float lacunarity = 2;  ///< frequency of an octave over that of the one before
  float gain = 0.5f;     ///< amplitude of an octave over that of the one before
  std::uint32_t seed = 0;

  /// mean_absolute: the mean of |noise|, measured over 2e7 points. absolute_is_finer: averaging attenuates |noise| as much as
  /// it attenuates noise whose features are finer by this factor.
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
