// ZSobolSampler: one Owen-scrambled Sobol sequence for all pixels of a picture, which take its blocks in a random Z-order.

#include <array>
#include <bit>

#include "owen_scrambling.h"

namespace etendue {
namespace {

// Ahmed & Wonka 2020 ("Screen-space blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering of pixels",
// ACM Transactions on Graphics 39(6)): pixels are ordered along Morton's curve, and pixel number z takes the points z n ... (z
// + 1) n
// - 1 of the sequence, n = 2^k. So the points of each pixel are a (0,k,2)-net, and those of each aligned square of 4^l pixels
// together a (0,k+2l,2)-net: errors of neighbouring pixels compensate each other, and the noise of the picture has the highest
// frequencies, which the eye, the film's filter and denoisers remove best. The order of the four squares within each square is
// random, for each pair of dimensions: a permutation of each digit in base 4, which depends on the digits before it.
//
// n must be known before the first sample: it is the member `samples`. Samples beyond it are the points n ... 2 n - 1, 2 n ...
// 4 n
// - 1, and so on: each of these ranges has a sequence of its own with as many points for a pixel, so that the error after any
// doubling falls at the rate of a net. It is up to 1.5 times that of one net of all samples.
//
// The place of the pixel is read from SampleKey::walk. Of a walk's first stream it is
//   mix_bits(s ^ (y 2^32 + x)), with s a hash of the seed,
// and mix_bits can be inverted. What is found are x and y with a fixed exclusive or of their digits: of the pixels of a
// picture, the upper halves of both words are those of s, and x and y appear in the lower halves, up to 65536 pixels along a
// side. A fixed exclusive or permutes the four squares within each square, as the random order does anyway. The keys of other
// streams (NumberStream::fork) give random places in random pictures, and so their points are those of SobolSampler: nets
// within a pixel, independent between pixels.

/// The inverse of mix_bits.
constexpr std::uint64_t unmix_bits(std::uint64_t v) {
  v ^= (v >> 31) ^ (v >> 62);
  v *= 0x319642b2d24d8ec3ull;
  v ^= (v >> 27) ^ (v >> 54);
  v *= 0x96de1b173f119089ull;
  v ^= (v >> 30) ^ (v >> 60);
  return v;
}
static_assert(unmix_bits(mix_bits(0x0123456789abcdefull)) == 0x0123456789abcdefull);

/// The bits of a 16-bit number at the even places.
constexpr std::uint32_t spread(std::uint32_t x) {
  x = (x | (x << 8)) & 0x00ff00ffu;
  x = (x | (x << 4)) & 0x0f0f0f0fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

/// The second Sobol coordinate of a 64-bit index, its first 32 digits, bit-reversed: as sobol_second_reversed, with a sixth
/// bit.
constexpr std::uint32_t sobol_second_reversed(std::uint64_t x) {
  return etendue::sobol_second_reversed(std::uint32_t(x) ^ std::uint32_t(x >> 32));
}

/// All permutations of a digit in base 4, two bits for the image of each.
constexpr std::array<std::uint8_t, 24> permutations = [] {
  std::array<std::uint8_t, 24> all{};
  size_t count = 0;
  for (unsigned a = 0; a < 4; ++a)
    for (unsigned b = 0; b < 4; ++b)
      for (unsigned c = 0; c < 4; ++c) {
        const unsigned d = 6 - a - b - c;
        if (a != b && a != c && b != c) all[count++] = std::uint8_t(a | b << 2 | c << 4 | d << 6);
      }
  return all;
}();

/// The random order: each digit of a Morton index in base 4 is permuted, by a hash of the digits above it.
std::uint32_t ordered(std::uint32_t morton, std::uint64_t seed) {
  std::uint32_t result = 0;
  for (std::uint32_t place = 0; place < 32; place += 2) {
    const std::uint64_t above = (std::uint64_t(morton) >> place >> 2) | (std::uint64_t(place + 1) << 32);
    const auto random = std::uint32_t(((seed ^ (above * 0x9e3779b97f4a7c15ull)) * 0xd6e8feb86659fd93ull) >> 32);
    const std::uint32_t permutation = permutations[(std::uint64_t(random) * 24) >> 32];
    result |= ((permutation >> (2 * ((morton >> place) & 3))) & 3) << place;
  }
  return result;
}

class ZSobolSampler final : public Sampler {
  int samples = 16;

 public:
  static void describe(Description<ZSobolSampler>& d) {
    d.summary(
         "Sobol points in a Z-order of the pixels: neighbouring pixels share a sequence, so that their errors compensate each "
         "other and the noise is fine. Set `samples` to the samples per pixel.",
         "Ahmed & Wonka 2020, Screen-space blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering of "
         "pixels")
        .member<&ZSobolSampler::samples>(
            "samples", "1",
            "the samples per pixel for which neighbours compensate each other best, rounded up to a "
            "power of two; more may be taken",
            range(1, 1 << 20), soft(1, 4096), logarithmic);
  }

  float number(SampleKey key, std::uint32_t dimension) const override { return point(key, dimension, false).x; }
  Point2 pair(SampleKey key, std::uint32_t dimension) const override { return point(key, dimension, true); }

 private:
  Point2 point(SampleKey key, std::uint32_t dimension, bool both) const {
    const std::uint64_t place = unmix_bits(key.walk);
    const auto x = std::uint32_t(place), y = std::uint32_t(place >> 32);
    // The range of samples, with 2^bits of them for each pixel.
    auto bits = std::uint32_t(std::bit_width(std::uint32_t(samples - 1)));
    std::uint32_t range = 0, within = key.sample;
    if (key.sample >> bits) {
      range = std::uint32_t(std::bit_width(key.sample >> bits));
      bits += range - 1;
      within -= 1u << bits;
    }
    // The same scrambling for all pixels: from the bits of the key that are the same for them.
    SampleKey picture;
    picture.walk = mix_bits((place & 0xffff0000ffff0000ull) + range);
    const std::uint64_t h = hash(picture, dimension);
    const std::uint32_t pixel = ordered(spread(x & 0xffff) | (spread(y & 0xffff) << 1), mix_bits(h));
    // The samples of a pixel are shuffled by a permutation of its own, so that two dimensions are independent within it, too.
    const std::uint64_t index = (std::uint64_t(pixel) << bits) | nested_permutation(within, bits, hash(key, dimension));
    const std::uint32_t first = scramble_reversed(std::uint32_t(index), std::uint32_t(h >> 32));
    if (!both) return {to_unit_float(reverse(first)), 0};
    const std::uint32_t second = scramble_reversed(sobol_second_reversed(index), second_seed(h));
    return {to_unit_float(reverse(first)), to_unit_float(reverse(second))};
  }
};

const Register<ZSobolSampler> registered;

}  // namespace
}  // namespace etendue
