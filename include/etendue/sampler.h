#pragma once
// Sampler: numbers in [0, 1) by pixel, sample and dimension.

#include "etendue/core/vector.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// Which sample of which pixel. `pixel` hashes the seed and the pixel, so that every number is a function of
/// (seed, pixel, sample, dimension) alone and any sample can be replayed alone.
struct SampleKey {
  std::uint64_t pixel = 0;
  std::uint32_t sample = 0;

  SampleKey() = default;
  SampleKey(std::uint64_t seed, int x, int y, std::uint32_t sample_)
      : pixel(mix_bits(mix_bits(seed + 0x9e3779b97f4a7c15ull) ^ ((std::uint64_t(std::uint32_t(y)) << 32) | std::uint32_t(x)))),
        sample(sample_) {}
};

/// Stateless: the same arguments give the same numbers, from any thread.
class Sampler : public Component {
 public:
  using Interface = Sampler;
  using Parent = Component;
  static void describe(Description<Sampler>&);

  /// One number in [0, 1).
  virtual float number(const SampleKey&, std::uint32_t dimension) const = 0;
  /// Two numbers, well spread together over the samples of a pixel; uses dimensions `dimension` and `dimension + 1`.
  virtual Point2 pair(const SampleKey&, std::uint32_t dimension) const = 0;
  /// The same pairs as two calls give, for samplers that find two at once with less work.
  struct Pairs {
    Point2 first, second;
  };
  virtual Pairs two_pairs(const SampleKey& key, std::uint32_t first, std::uint32_t second) const {
    return {pair(key, first), pair(key, second)};
  }
};

/// A sample's numbers in the order an algorithm asks for them.
class SampleStream {
 public:
  SampleStream(const Sampler& sampler, const SampleKey& key) : sampler_(&sampler), key_(key) {}

  float next() { return sampler_->number(key_, dimension_++); }
  Point2 next_pair() {
    const Point2 p = sampler_->pair(key_, dimension_);
    dimension_ += 2;
    return p;
  }
  /// The numbers of a bounce, in this order: which luminaire, where on it, which lobe, where in it. They depend on nothing, so
  /// the processor finds them while it does the rest. A choice among one alone is passed over.
  struct Bounce {
    float light_choice = 0, lobe_choice = 0;
    Point2 light_point, direction;
  };
  Bounce next_bounce(bool several_lights, bool several_lobes) {
    const std::uint32_t first = dimension_;
    dimension_ += 6;
    const Sampler::Pairs pairs = sampler_->two_pairs(key_, first + 1, first + 4);
    return {several_lights ? sampler_->number(key_, first) : 0, several_lobes ? sampler_->number(key_, first + 3) : 0,
            pairs.first, pairs.second};
  }
  /// Passes over one number that will not be looked at; those that follow are the same as if it had been taken.
  void skip() { ++dimension_; }
  std::uint32_t dimension() const { return dimension_; }
  /// Continues at a given dimension, so that parts of a path keep their dimensions whatever went before.
  void jump(std::uint32_t dimension) { dimension_ = dimension; }
  const SampleKey& key() const { return key_; }

 private:
  const Sampler* sampler_;
  SampleKey key_;
  std::uint32_t dimension_ = 0;
};

}  // namespace etendue
