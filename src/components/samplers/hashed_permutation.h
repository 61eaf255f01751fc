#pragma once
// Random permutations without tables.

#include <bit>

#include "etendue/core/math.h"

namespace etendue {

/// A pseudo-random permutation of 0 ... n - 1: bijections of the next power of two, repeated until the value is below n (cycle
/// walking, as in Kensler 2013, "Correlated multi-jittered sampling").
inline std::uint32_t permuted(std::uint32_t i, std::uint32_t n, std::uint64_t seed) {
  const std::uint32_t bits = std::uint32_t(std::bit_width(n - 1)), mask = std::uint32_t((1ull << bits) - 1);
  const std::uint32_t half = (bits + 1) / 2;
  do {
    std::uint64_t random = seed;
    for (int round = 0; round < 4; ++round) {
      random = mix_bits(random + 0x9e3779b97f4a7c15ull);
      i = (i * (std::uint32_t(random) | 1) + std::uint32_t(random >> 32)) & mask;
      i ^= i >> half;
    }
  } while (i >= n);
  return i;
}

}  // namespace etendue
