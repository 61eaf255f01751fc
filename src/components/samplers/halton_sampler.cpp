// HaltonSampler: Owen-scrambled Halton points, a prime base for each dimension.

#include <array>

#include "owen_scrambling.h"

namespace etendue {
namespace {

// Dimension d is the radical inverse in base b, the d-th prime (Halton 1960): the digits of the sample's index, mirrored at the
// point. Any b^k consecutive samples have one number in each interval of length b^-k, and any b^k c^l consecutive samples one
// point in each box b^-k x c^-l of two dimensions with bases b and c.
//
// Each digit is scrambled by a permutation that depends on the digits before it (Owen 1995, "Randomly permuted (t,m,s)-nets and
// (t,s)-sequences"), of the form d -> a d + c mod b with random a != 0 and c. For prime b these permutations map any two
// different digits to any two different digits with equal probabilities, as all permutations do; variances depend on no more
// than that (Matousek 1998, "On the L2-discrepancy for anchored boxes"). Scramblings differ between pixels, walks and
// dimensions.
//
// Bases are large in high dimensions, where points are no better than independent ones until there are as many as the base.
// Beyond the table of primes the bases begin anew, with other scramblings, under which equal bases are independent too.

constexpr size_t base_count = 128;

constexpr std::array<std::uint32_t, base_count> first_primes() {
  std::array<std::uint32_t, base_count> primes{};
  size_t count = 0;
  for (std::uint32_t n = 2; count < base_count; ++n) {
    bool prime = true;
    for (size_t i = 0; i < count && primes[i] * primes[i] <= n; ++i) prime = prime && n % primes[i] != 0;
    if (prime) primes[count++] = n;
  }
  return primes;
}
constexpr std::array<std::uint32_t, base_count> primes = first_primes();

/// The scrambled radical inverse of an index in an odd prime base. Digits are scrambled down to intervals below 2^-24, the
/// precision of the result; the place within the last interval is uniform, as the scrambling of all further digits makes it.
float scrambled_inverse(std::uint32_t index, std::uint32_t base, std::uint64_t seed) {
  std::uint64_t digits = 0, cells = 1, prefix = seed;
  while (cells < (1u << 24)) {
    const std::uint32_t digit = index % base;
    index /= base;
    const std::uint64_t random = mix_bits(prefix);
    const std::uint64_t factor = 1 + (((random & 0xffffffffu) * (base - 1)) >> 32), shift = ((random >> 32) * base) >> 32;
    digits = digits * base + (factor * digit + shift) % base;
    cells *= base;
    prefix = (random ^ digit) * 0x9e3779b97f4a7c15ull;
  }
  // 16 further bits, so that the sum is exact, and below 1 after the division.
  const double within = double(mix_bits(prefix ^ index) >> 48) * 0x1p-16;
  return float(std::uint32_t((double(digits) + within) / double(cells) * 0x1p24)) * 0x1p-24f;
}

class HaltonSampler final : public Sampler {
 public:
  static void describe(Description<HaltonSampler>& d) {
    d.summary(
        "Owen-scrambled Halton points: each dimension has a prime base of its own. Good for any number of samples in the first "
        "dimensions of a path; in later ones only for as many samples as their bases, up to hundreds.",
        "Halton 1960, On the efficiency of certain quasi-random sequences of points in evaluating multi-dimensional integrals; "
        "Owen 1995, Randomly permuted (t,m,s)-nets and (t,s)-sequences");
  }

  float number(SampleKey key, std::uint32_t dimension) const override {
    const std::uint64_t h = hash(key, dimension);
    const std::uint32_t base = primes[dimension % base_count];
    if (base == 2) return to_unit_float(reverse(scramble_reversed(key.sample, std::uint32_t(h >> 32))));
    return scrambled_inverse(key.sample, base, h);
  }

  Point2 pair(SampleKey key, std::uint32_t dimension) const override {
    return {number(key, dimension), number(key, dimension + 1)};
  }
};

const Register<HaltonSampler> registered;

}  // namespace
}  // namespace etendue
