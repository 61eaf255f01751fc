#pragma once
// Primary samples (Kelemen et al. 2002): a path, with its film point, lens point, time, wavelengths, directions and choices, is
// a function of uniform numbers in [0, 1). NumberSource supplies these numbers, and NumberStream hands them out in sequence.
// Another source (a recording, a mutation) gives another path of the same algorithm.

#include "etendue/core/math.h"
#include "etendue/core/vector.h"

namespace etendue {

/// Identifies the sequence of primary samples of one walk of one sample. `walk` is a hash of the seed, the pixel and the names
/// of walks (see NumberStream::fork). So every number is a function of (seed, pixel, sample, walk, dimension) alone, and any
/// sample can be replayed by itself.
struct SampleKey {
  std::uint64_t walk = 0;
  std::uint32_t sample = 0;

  SampleKey() = default;
  SampleKey(std::uint64_t seed, int x, int y, std::uint32_t sample_)
      : walk(mix_bits(mix_bits(seed + 0x9e3779b97f4a7c15ull) ^ ((std::uint64_t(std::uint32_t(y)) << 32) | std::uint32_t(x)))),
        sample(sample_) {}
};

/// A source of primary samples: the same arguments give the same numbers. Samplers are sources;
/// transport/primary_sample_vectors.h has sources that record and mutate numbers. Keys are passed by value, in registers: a
/// copy from memory where one half was just written would wait for that write (a store-forwarding stall).
class NumberSource {
 public:
  /// One number in [0, 1).
  virtual float number(SampleKey, std::uint32_t dimension) const = 0;
  /// Two numbers that are well distributed in the unit square over the samples of a walk. Uses the dimensions `dimension` and
  /// `dimension + 1`.
  virtual Point2 pair(SampleKey, std::uint32_t dimension) const = 0;
  /// The same pairs as two calls of `pair`, for sources that compute two at once faster.
  struct Pairs {
    Point2 first, second;
  };
  virtual Pairs two_pairs(SampleKey key, std::uint32_t first, std::uint32_t second) const {
    return {pair(key, first), pair(key, second)};
  }

 protected:
  ~NumberSource() = default;
};

/// The name of a walk, hashed at compile time (FNV-1a).
struct WalkName {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  consteval WalkName(const char* name) {
    for (; *name; ++name) hash = (hash ^ std::uint64_t(*name)) * 0x100000001b3ull;
  }
};

/// The primary samples of a walk, in the order of the calls. A small value type: a copy continues independently.
class NumberStream {
 public:
  NumberStream(const NumberSource& source, SampleKey key) : source_(&source), key_(key) {}

  float next() { return source_->number(key_, dimension_++); }
  Point2 next_pair() {
    const Point2 p = source_->pair(key_, dimension_);
    dimension_ += 2;
    return p;
  }
  /// The primary samples of a bounce, in this order: choice of the luminaire, point on it, choice of the lobe, direction within
  /// it. They do not depend on the vertex, so the processor computes them in parallel with other work. With only one luminaire
  /// or lobe the number of the choice is skipped.
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
  /// Skips numbers that are not used; the following numbers are the same as if these had been taken.
  void skip(std::uint32_t count = 1) { dimension_ += count; }

  /// An independent stream for another part of the same sample, identified by a name and an index (for several streams of one
  /// name). It does not depend on how many numbers of this stream were used.
  NumberStream fork(WalkName name, std::uint32_t index = 0) const {
    NumberStream other = *this;
    other.key_.walk = mix_bits(key_.walk ^ (name.hash + index * 0x9e3779b97f4a7c15ull));
    other.dimension_ = 0;
    return other;
  }

  SampleKey key() const { return key_; }
  /// The count of numbers that were taken or skipped.
  std::uint32_t count() const { return dimension_; }

 private:
  const NumberSource* source_;
  SampleKey key_;
  std::uint32_t dimension_ = 0;
};

}  // namespace etendue
