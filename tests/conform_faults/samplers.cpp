// Samplers with one fault each, which `etendue conform` must find.

#include <atomic>

#include "etendue/sampler.h"

namespace etendue {
namespace {

/// Independent numbers, from which the faulty ones are made.
std::uint32_t bits(SampleKey key, std::uint32_t dimension) {
  return std::uint32_t(mix_bits(mix_bits(key.walk + dimension) ^ key.sample) >> 32);
}

class RightSampler : public Sampler {
 public:
  float number(SampleKey key, std::uint32_t dimension) const override { return to_unit_float(bits(key, dimension)); }
  Point2 pair(SampleKey key, std::uint32_t dimension) const override {
    return {number(key, dimension), number(key, dimension + 1)};
  }
};

class ClosedSampler final : public RightSampler {
 public:
  static void describe(Description<ClosedSampler>& d) { d.summary("Rounds numbers up, to 1 as well."); }
  float number(SampleKey key, std::uint32_t dimension) const override { return float((bits(key, dimension) >> 24) + 1) / 256; }
};
const Register<ClosedSampler> closed;

class SkewedSampler final : public RightSampler {
 public:
  static void describe(Description<SkewedSampler>& d) { d.summary("Gives somewhat more small numbers."); }
  float number(SampleKey key, std::uint32_t dimension) const override {
    return std::min(std::pow(RightSampler::number(key, dimension), 1.05f), one_minus_epsilon);
  }
};
const Register<SkewedSampler> skewed;

class DrawingSampler final : public RightSampler {
 public:
  static void describe(Description<DrawingSampler>& d) { d.summary("Gives the next number of a series, whoever asks."); }
  float number(SampleKey, std::uint32_t) const override {
    static std::atomic<std::uint64_t> state = 0;
    return to_unit_float(std::uint32_t(mix_bits(++state) >> 32));
  }
};
const Register<DrawingSampler> drawing;

class OneSeedSampler final : public RightSampler {
 public:
  static void describe(Description<OneSeedSampler>& d) { d.summary("Has the same numbers in all pixels."); }
  float number(SampleKey key, std::uint32_t dimension) const override {
    key.walk = 0;
    return RightSampler::number(key, dimension);
  }
};
const Register<OneSeedSampler> one_seed;

class ClumpedSampler final : public RightSampler {
 public:
  static void describe(Description<ClumpedSampler>& d) { d.summary("Puts a pixel's samples near to one another."); }
  float number(SampleKey key, std::uint32_t dimension) const override {
    const std::uint32_t own = bits(key, dimension);
    key.sample = 0;
    return to_unit_float(bits(key, dimension) + (own >> 1));
  }
};
const Register<ClumpedSampler> clumped;

/// Each number is uniform, each dimension stratified, and pixels are independent; but the order of the strata is the same in
/// all dimensions.
class UnshuffledSampler final : public RightSampler {
 public:
  static void describe(Description<UnshuffledSampler>& d) { d.summary("Shifts the same points in every dimension."); }
  float number(SampleKey key, std::uint32_t dimension) const override {
    const std::uint32_t point = key.sample * 0x9e3779b9u;
    key.sample = 0;
    return to_unit_float(point + bits(key, dimension));
  }
};
const Register<UnshuffledSampler> unshuffled;

class HastySampler final : public RightSampler {
 public:
  static void describe(Description<HastySampler>& d) { d.summary("Two pairs at once are others."); }
  Pairs two_pairs(SampleKey key, std::uint32_t first, std::uint32_t second) const override {
    return {pair(key, first), pair(key, second + 1)};
  }
};
const Register<HastySampler> hasty;

}  // namespace
}  // namespace etendue
