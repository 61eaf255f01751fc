#pragma once
// Hash-based Owen scrambling in base 2 (Burley 2020, "Practical hash-based Owen scrambling", Journal of Computer Graphics
// Techniques 9(4)), which the samplers of digital sequences share.
//
// A nested uniform permutation (Owen 1995) exchanges the two halves of each binary interval at random. It keeps aligned blocks
// of 2^k indices, and elementary intervals of coordinates: a (0,m,2)-net stays one.

#include "etendue/sampler.h"

namespace etendue {

constexpr std::uint32_t reverse(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/// Reverses the bits of both halves at once, and swaps them: the upper half of the result is the reversed lower half of x, the
/// lower half the reversed upper half.
constexpr std::uint64_t reverse_both(std::uint64_t x) {
  x = __builtin_bswap64(x);
  x = ((x >> 4) & 0x0f0f0f0f0f0f0f0full) | ((x & 0x0f0f0f0f0f0f0f0full) << 4);
  x = ((x >> 2) & 0x3333333333333333ull) | ((x & 0x3333333333333333ull) << 2);
  return ((x >> 1) & 0x5555555555555555ull) | ((x & 0x5555555555555555ull) << 1);
}

/// Four numbers at once, here and in the functions below.
using Four = std::uint32_t __attribute__((vector_size(16)));
inline Four reverse(Four x) {
  x = (x >> 16) | (x << 16);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/// A hash in which each bit depends on lower bits and itself alone (Laine & Karras 2011; constants of Burley 2020, listing
/// 3). On reversed bits this is a nested uniform permutation.
template <class Bits>
constexpr Bits permute_reversed(Bits x, Bits seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

/// The same with constants and a multiplication by the seed that Vegdahl found (as in pbrt-v4), which make the permutations of
/// two seeds less alike.
constexpr std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// The bit-reversed second Sobol coordinate of a point's index. Its generator matrix is Pascal's triangle modulo 2: digit i
/// is the exclusive or of the index bits j with binomial(j, i) odd, which are those whose j has all bits of i (Lucas). The
/// sum over such supersets takes one step for each of the five bits of j.
template <class Bits>
constexpr Bits sobol_second_reversed(Bits x) {
  x ^= (x >> 1) & 0x55555555u;
  x ^= (x >> 2) & 0x33333333u;
  x ^= (x >> 4) & 0x0f0f0f0fu;
  x ^= (x >> 8) & 0x00ff00ffu;
  x ^= x >> 16;
  return x;
}

/// The index of a sample's point: each pair of dimensions has its own random order of the points.
inline std::uint32_t shuffled(std::uint32_t sample, std::uint64_t hash) {
  return reverse(permute_reversed(reverse(sample), std::uint32_t(hash)));
}

inline std::uint32_t reordered(std::uint32_t sample, std::uint64_t hash) {
  return reverse(scramble_reversed(reverse(sample), std::uint32_t(hash)));
}

/// The key is well mixed already: one multiplication, whose halves are combined, spreads the dimension over all bits.
inline std::uint64_t hash(SampleKey key, std::uint32_t dimension) {
  __extension__ using Wide = unsigned __int128;
  const Wide product = Wide(key.walk ^ ((std::uint64_t(dimension) + 1) * 0x9e3779b97f4a7c15ull)) * 0xd6e8feb86659fd93ull;
  return std::uint64_t(product >> 64) ^ std::uint64_t(product);
}

inline std::uint32_t second_seed(std::uint64_t hash) { return std::uint32_t((hash * 0xd1342543de82ef95ull) >> 32); }

/// A nested permutation of the numbers below 2^bits: each bit is flipped by a hash of the bits above it.
inline std::uint32_t nested_permutation(std::uint32_t i, std::uint32_t bits, std::uint64_t seed) {
  std::uint32_t flips = 0;
  for (std::uint32_t bit = 0; bit < bits; ++bit) {
    const std::uint64_t above = (std::uint64_t(i >> bit >> 1) << 6) | bit;
    flips |= std::uint32_t(((seed ^ (above * 0x9e3779b97f4a7c15ull)) * 0xd6e8feb86659fd93ull) >> 63) << bit;
  }
  return i ^ flips;
}

}  // namespace etendue
