// SobolSampler: Owen-scrambled Sobol points, two dimensions at a time.

#include "etendue/sampler.h"

namespace etendue {
namespace {

// Each pair of dimensions is the first two dimensions of Sobol's sequence, a (0,2)-sequence in base 2: the first 2^k
// points (and every aligned block of 2^k) have one point in each elementary interval of area 2^-k. Pairs are made
// independent of each other ("padding") by giving each its own order of the points and its own scrambling; both are
// nested uniform permutations, which keep the blocks and the intervals (Burley 2020, "Practical hash-based Owen
// scrambling", Journal of Computer Graphics Techniques 9(4)).

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
std::uint32_t shuffled(std::uint32_t sample, std::uint64_t hash) {
  return reverse(permute_reversed(reverse(sample), std::uint32_t(hash)));
}

/// The key is well mixed already: one multiplication, whose halves are combined, spreads the dimension over all bits.
std::uint64_t hash(SampleKey key, std::uint32_t dimension) {
  __extension__ using Wide = unsigned __int128;
  const Wide product = Wide(key.walk ^ ((std::uint64_t(dimension) + 1) * 0x9e3779b97f4a7c15ull)) * 0xd6e8feb86659fd93ull;
  return std::uint64_t(product >> 64) ^ std::uint64_t(product);
}

std::uint32_t second_seed(std::uint64_t hash) { return std::uint32_t((hash * 0xd1342543de82ef95ull) >> 32); }

class SobolSampler final : public Sampler {
 public:
  static void describe(Description<SobolSampler>& d) {
    d.summary(
        "Owen-scrambled Sobol points, each pair of dimensions well spread over a pixel's samples; best with a power of two of "
        "them.",
        "Burley 2020, Practical hash-based Owen scrambling");
  }

  float number(SampleKey key, std::uint32_t dimension) const override {
    const std::uint64_t h = hash(key, dimension);
    const std::uint32_t index = shuffled(key.sample, h);
    return to_unit_float(reverse(permute_reversed(index, std::uint32_t(h >> 32))));
  }

  Point2 pair(SampleKey key, std::uint32_t dimension) const override {
    const std::uint64_t h = hash(key, dimension);
    const std::uint32_t index = shuffled(key.sample, h);
    const std::uint32_t x = permute_reversed(index, std::uint32_t(h >> 32));
    const std::uint32_t y = permute_reversed(sobol_second_reversed(index), second_seed(h));
    const std::uint64_t both = reverse_both((std::uint64_t(y) << 32) | x);
    return {to_unit_float(std::uint32_t(both >> 32)), to_unit_float(std::uint32_t(both))};
  }

  Pairs two_pairs(SampleKey key, std::uint32_t first, std::uint32_t second) const override {
    const std::uint64_t g = hash(key, first), h = hash(key, second);
    const auto g_low = std::uint32_t(g), h_low = std::uint32_t(h), start = reverse(key.sample);
    const Four index = reverse(permute_reversed(Four{start, start, start, start}, Four{g_low, g_low, h_low, h_low}));
    constexpr Four second_ones{0, ~0u, 0, ~0u};
    const Four point = (index & ~second_ones) | (sobol_second_reversed(index) & second_ones);
    const Four seeds{std::uint32_t(g >> 32), second_seed(g), std::uint32_t(h >> 32), second_seed(h)};
    const Four bits = reverse(permute_reversed(point, seeds));
    return {{to_unit_float(bits[0]), to_unit_float(bits[1])}, {to_unit_float(bits[2]), to_unit_float(bits[3])}};
  }
};

const Register<SobolSampler> registered;

}  // namespace
}  // namespace etendue
