// LatticeSampler: randomly shifted rank-1 lattices, two dimensions at a time.

#include "owen_scrambling.h"

namespace etendue {
namespace {

// The points i (1, a) / n mod 1, i = 0 ... n - 1, are a rank-1 lattice (Sloan & Joe 1994). Their mean of a function is off by
// its Fourier coefficients at the frequencies of the dual lattice alone, the h with h_x + a h_y = 0 mod n: the longer the
// shortest of these, the better. With i / n replaced by the van der Corput sequence, every aligned block of n = 2^k points is a
// shifted lattice of n points, for any k (Hickernell, Hong, L'Ecuyer & Lemieux 2000, "Extensible lattice sequences for
// quasi-Monte Carlo quadrature").
//
// `generator` is a, digit by digit in base 2, with as long a shortest dual vector for all n = 2^k, k = 3 ... 32 as a search
// with 3000 candidates for each digit found: at least 0.705 of that of the best lattice in the plane, the hexagonal one, whose
// length is sqrt(2 n / sqrt(3)). (For n = 4 every odd a gives 0.658.)
//
// Pairs of dimensions are made independent by a shift of their own, uniform in the unit square (Cranley & Patterson 1976),
// which makes each point uniform, and by their own order of the points, a nested permutation that keeps aligned blocks.

constexpr std::uint32_t generator = 0xf3204613u;

class LatticeSampler final : public Sampler {
 public:
  static void describe(Description<LatticeSampler>& d) {
    d.summary(
        "Randomly shifted rank-1 lattices, for each pair of dimensions its own; best with a power of two of samples. Strongest "
        "where the integrand is smooth and periodic.",
        "Sloan & Joe 1994, Lattice methods for multiple integration; Hickernell, Hong, L'Ecuyer & Lemieux 2000, Extensible "
        "lattice sequences for quasi-Monte Carlo quadrature");
  }

  float number(SampleKey key, std::uint32_t dimension) const override { return pair(key, dimension).x; }

  Point2 pair(SampleKey key, std::uint32_t dimension) const override {
    const std::uint64_t h = hash(key, dimension);
    // Fractions of 2^32, modulo 1.
    const std::uint32_t i = reverse(reordered(key.sample, h));
    return {to_unit_float(i + std::uint32_t(h >> 32)), to_unit_float(i * generator + second_seed(h))};
  }
};

const Register<LatticeSampler> registered;

}  // namespace
}  // namespace etendue
