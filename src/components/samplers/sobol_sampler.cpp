// SobolSampler: Owen-scrambled Sobol points, two dimensions at a time.

#include "owen_scrambling.h"

namespace etendue {
namespace {

// Each pair of dimensions is the first two dimensions of Sobol's sequence, a (0,2)-sequence in base 2: the first 2^k
// points (and every aligned block of 2^k) have one point in each elementary interval of area 2^-k. Pairs are made
// independent of each other ("padding") by giving each its own order of the points and its own scrambling; both are
// nested uniform permutations, which keep the blocks and the intervals (Burley 2020, "Practical hash-based Owen
// scrambling", Journal of Computer Graphics Techniques 9(4)).

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
