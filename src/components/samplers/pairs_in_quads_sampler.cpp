// PairsInQuadsSampler: four dimensions at a time, a (0,4)-sequence in base 4 whose two pairs are (0,2)-sequences in base 2.

#include "owen_scrambling.h"

namespace etendue {
namespace {

// Ahmed, Pharr, Ostromoukhov & Huang 2025 ("SZ sequences: binary-based (0, 2^q)-sequences") showed that two (0,2)-sequences in
// base 2 can be assembled into a (0,4)-sequence in base 4: the first 4^m points (and every aligned block of as many) have one
// point in each of the boxes 4^-a x 4^-b x 4^-c x 4^-d with a + b + c + d = m. Their matrices were found by search. The ones
// here have the same properties by this argument; they need not be the same matrices.
//
// Let w be a generator of GF(4), P(g) the matrix with the entries binomial(j, i) g^(j-i) over GF(4) at row i and column j
// (P(0) is the identity). P(0), P(1), P(w) and P(w^2) generate a (0,4)-sequence in base 4 (Faure 1982, for prime bases;
// Niederreiter 1987, Theorem 6.2, for fields), and P(g) P(h) = P(g + h). Written as a matrix over GF(2), an element is a 2 x 2
// block, and P(g) is upper triangular, since its diagonal blocks are g^0 = 1. With Pascal's matrix S over GF(2), the second
// matrix of Sobol's sequence, let
//   C0 = 1, C1 = S, C2 = P(w), C3 = S P(w).
// - (C0, C1) generate Sobol's (0,2)-sequence in base 2. So do (C2, C3) = (C0 U, C1 U) with U = P(w): as U is upper triangular
//   and regular, it maps each aligned block of 2^k indices to such a block (Hofer & Suzuki 2019).
// - By the theorem of Lucas, S = D P(1) where D has the diagonal blocks (1 1; 0 1): binomial(2 j + b, 2 i + a) =
//   binomial(j, i) binomial(b, a) modulo 2. So C1 = D P(1) and C3 = D P(1) P(w) = D P(w^2). D permutes the values of each
//   digit in base 4, which does not change which boxes have how many points.
//
// Nested uniform permutations of the index and the coordinates in base 2 are such permutations in base 4 as well, so all of
// this remains after Owen's scrambling. A quad holds pairs whose light is multiplied: film and point on the first luminaire;
// direction of a bounce and point on the luminaire of the next one.

constexpr std::uint32_t low_bits = 0x55555555u;  ///< of the digits in base 4

/// The digits in base 4, each times w or w^2 = w + 1 of GF(4). A digit (high, low) is the element high w + low.
constexpr std::uint32_t times_w(std::uint32_t x) {
  const std::uint32_t high = (x >> 1) & low_bits, low = x & low_bits;
  return ((high ^ low) << 1) | high;
}
constexpr std::uint32_t times_w2(std::uint32_t x) {
  const std::uint32_t high = (x >> 1) & low_bits, low = x & low_bits;
  return (low << 1) | (high ^ low);
}

/// The product of P(w) and the digits of an index. P(w) is a scaling of digit i by w^-i, Pascal's matrix of digits, and a
/// scaling of digit j by w^j; as w^3 = 1, every third digit has the same factor. Pascal's matrix sums over supersets of the
/// bits of i, one step for each of the four bits of a digit's place (SobolSampler has five: its digits are bits).
constexpr std::uint32_t times_pascal_of_w(std::uint32_t x) {
  constexpr std::uint32_t ones = 0x0c30c30cu, twos = 0x30c30c30u;  // digits whose place is 1 or 2 modulo 3
  x = (x & ~(ones | twos)) | (times_w(x) & ones) | (times_w2(x) & twos);
  x ^= (x >> 2) & 0x33333333u;
  x ^= (x >> 4) & 0x0f0f0f0fu;
  x ^= (x >> 8) & 0x00ff00ffu;
  x ^= x >> 16;
  return (x & ~(ones | twos)) | (times_w2(x) & ones) | (times_w(x) & twos);
}

/// The quad that a pair belongs to, and whether it is its second pair. Every dimension has its own place. Pairs that begin
/// three dimensions apart share a quad: a bounce (NumberStream::next_bounce) has six dimensions, with the point on the
/// luminaire at the second and the direction at the fifth. The film's point, the first pair of a camera path, takes the first
/// bounce's point on a luminaire.
struct Place {
  std::uint32_t quad;
  bool second;
};
constexpr Place place_of(std::uint32_t dimension) {
  constexpr std::uint32_t first_light_point = 7;
  if (dimension == 0 || dimension == first_light_point) return {0, dimension != 0};
  const bool second = dimension % 6 < 3;
  return {second ? dimension - 3 : dimension, second};
}

/// A key whose hashes are independent of those that numbers and scramblings have.
SampleKey apart(SampleKey key) {
  key.walk ^= 0x94d049bb133111ebull;
  return key;
}

class PairsInQuadsSampler final : public Sampler {
 public:
  static void describe(Description<PairsInQuadsSampler>& d) {
    d.summary(
        "Owen-scrambled (0,4)-sequences in base 4 whose two pairs are (0,2)-sequences in base 2: as well spread as "
        "SobolSampler "
        "over pairs of dimensions, and over four together, such as the film and a luminaire; best with a power of 4 of "
        "samples.",
        "Ahmed, Pharr, Ostromoukhov & Huang 2025, SZ sequences: binary-based (0, 2^q)-sequences; the matrices are derived from "
        "those of Niederreiter 1987, Point sets and sequences with small discrepancy");
  }

  float number(SampleKey key, std::uint32_t dimension) const override {
    const std::uint64_t h = hash(key, dimension);
    return to_unit_float(reverse(scramble_reversed(reordered(key.sample, h), std::uint32_t(h >> 32))));
  }

  Point2 pair(SampleKey key, std::uint32_t dimension) const override {
    const Place place = place_of(dimension);
    const std::uint64_t quad = hash(apart(key), place.quad), h = hash(key, dimension);
    const std::uint32_t index = reordered(key.sample, quad);
    const std::uint32_t point = place.second ? times_pascal_of_w(index) : index;
    const std::uint32_t x = scramble_reversed(point, std::uint32_t(h >> 32));
    const std::uint32_t y = scramble_reversed(sobol_second_reversed(point), second_seed(h));
    return {to_unit_float(reverse(x)), to_unit_float(reverse(y))};
  }
};

const Register<PairsInQuadsSampler> registered;

}  // namespace
}  // namespace etendue
