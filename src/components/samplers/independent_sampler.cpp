// IndependentSampler: independent pseudo-random numbers.

#include "etendue/sampler.h"

namespace etendue {
namespace {

// Counter based: a number is a hash of its own indices. The product of the counter (sample, dimension) and an odd constant is a
// bijection of the counter; its exclusive or with the pixel's hash runs through another part of the hash's domain in every
// pixel, like the state of splitmix64 (Steele, Lea & Flood 2014).
std::uint64_t bits(SampleKey key, std::uint32_t dimension) {
  const std::uint64_t counter = (std::uint64_t(key.sample) << 32) | dimension;
  return mix_bits(key.walk ^ ((counter + 1) * 0x9e3779b97f4a7c15ull));
}

class IndependentSampler final : public Sampler {
 public:
  static void describe(Description<IndependentSampler>& d) {
    d.summary("Independent uniform numbers: the plainest estimate, and the noisiest.",
              "Steele, Lea & Flood 2014, Fast splittable pseudorandom number generators");
  }
  float number(SampleKey key, std::uint32_t dimension) const override {
    return to_unit_float(std::uint32_t(bits(key, dimension) >> 32));
  }
  Point2 pair(SampleKey key, std::uint32_t dimension) const override { return halves(bits(key, dimension)); }
  Pairs two_pairs(SampleKey key, std::uint32_t first, std::uint32_t second) const override {
    return {halves(bits(key, first)), halves(bits(key, second))};
  }

 private:
  static Point2 halves(std::uint64_t h) { return {to_unit_float(std::uint32_t(h >> 32)), to_unit_float(std::uint32_t(h))}; }
};

const Register<IndependentSampler> registered;

}  // namespace
}  // namespace etendue
