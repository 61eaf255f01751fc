#pragma once
// Numbers: what a path is made of. Its place on the film, its lens point, time and wavelengths, its directions and choices
// are a function of uniform numbers in [0, 1): whoever gives others (a recording, a mutation) gets another path of the same
// algorithm.

#include "etendue/core/math.h"
#include "etendue/core/vector.h"

namespace etendue {

/// Which numbers: those of one walk of one sample. `walk` hashes the seed, the pixel and the names of walks (see
/// NumberStream::fork), so that every number is a function of (seed, pixel, sample, walk, dimension) alone and any sample can
/// be replayed alone.
struct SampleKey {
  std::uint64_t walk = 0;
  std::uint32_t sample = 0;

  SampleKey() = default;
  SampleKey(std::uint64_t seed, int x, int y, std::uint32_t sample_)
      : walk(mix_bits(mix_bits(seed + 0x9e3779b97f4a7c15ull) ^ ((std::uint64_t(std::uint32_t(y)) << 32) | std::uint32_t(x)))),
        sample(sample_) {}
};

/// Where numbers come from. Keys are handed over by value, in registers: copied from memory where one part was just written
/// they would wait for it. The same arguments give the same numbers. A Sampler is one; see transport/primary_sample_vectors.h
/// for those that remember and change them.
class NumberSource {
 public:
  /// One number in [0, 1).
  virtual float number(SampleKey, std::uint32_t dimension) const = 0;
  /// Two numbers, well spread together over the samples of a walk; uses dimensions `dimension` and `dimension + 1`.
  virtual Point2 pair(SampleKey, std::uint32_t dimension) const = 0;
  /// The same pairs as two calls give, for sources that find two at once with less work.
  struct Pairs {
    Point2 first, second;
  };
  virtual Pairs two_pairs(SampleKey key, std::uint32_t first, std::uint32_t second) const {
    return {pair(key, first), pair(key, second)};
  }

 protected:
  ~NumberSource() = default;
};

/// The name of a walk, hashed when it is compiled (FNV-1a).
struct WalkName {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  consteval WalkName(const char* name) {
    for (; *name; ++name) hash = (hash ^ std::uint64_t(*name)) * 0x100000001b3ull;
  }
};

/// A walk's numbers, in the order an algorithm asks for them. A small value: a copy goes on by itself.
class NumberStream {
 public:
  NumberStream(const NumberSource& source, SampleKey key) : source_(&source), key_(key) {}

  float next() { return source_->number(key_, dimension_++); }
  Point2 next_pair() {
    const Point2 p = source_->pair(key_, dimension_);
    dimension_ += 2;
    return p;
  }
  /// The numbers of a bounce, in this order: which luminaire, where on it, which lobe, where in it. They depend on nothing, so
  /// the processor finds them while it does the rest. A choice among one alone is passed over.
  struct Bounce {
    float light_choice = 0, lobe_choice = 0;
    Point2 light_point, direction;
  };
  Bounce next_bounce(bool several_lights = true, bool several_lobes = true) {
    const std::uint32_t first = dimension_;
    dimension_ += 6;
    const NumberSource::Pairs pairs = source_->two_pairs(key_, first + 1, first + 4);
    return {several_lights ? source_->number(key_, first) : 0, several_lobes ? source_->number(key_, first + 3) : 0,
            pairs.first, pairs.second};
  }
  /// Passes over numbers that will not be looked at; those that follow are the same as if they had been taken.
  void skip(std::uint32_t count = 1) { dimension_ += count; }

  /// Numbers of their own for another part of the same sample, by its name and, of many such, its index: they are the same
  /// whatever this walk has used or will use.
  NumberStream fork(WalkName name, std::uint32_t index = 0) const {
    NumberStream other = *this;
    other.key_.walk = mix_bits(key_.walk ^ (name.hash + index * 0x9e3779b97f4a7c15ull));
    other.dimension_ = 0;
    return other;
  }

  SampleKey key() const { return key_; }
  /// How many were taken or passed over.
  std::uint32_t count() const { return dimension_; }

 private:
  const NumberSource* source_;
  SampleKey key_;
  std::uint32_t dimension_ = 0;
};

}  // namespace etendue
