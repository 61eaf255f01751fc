#pragma once
// Numbers that are remembered, and changed: for algorithms that walk through the space of paths.

#include <cstddef>
#include <span>
#include <unordered_map>
#include <vector>

#include "etendue/numbers.h"

namespace etendue {

/// What another source gave for one sample, kept: asked again it gives the same, also when the other source is gone or has
/// changed.
class RecordedNumbers final : public NumberSource {
 public:
  explicit RecordedNumbers(const NumberSource& source) : source_(&source) {}
  /// From now on what was never asked for is 0.5.
  void close() { source_ = nullptr; }

  float number(SampleKey, std::uint32_t dimension) const override;
  Point2 pair(SampleKey, std::uint32_t dimension) const override;

 private:
  const NumberSource* source_;
  mutable std::unordered_map<std::uint64_t, std::unordered_map<std::uint32_t, float>> walks_;
};

/// The state of a Markov chain in the space of numbers (Kelemen, Szirmay-Kalos, Antal & Csonka 2002, "A simple and robust
/// mutation strategy for the Metropolis light transport algorithm"). `large_step` and `small_step` propose another state, which
/// the source then gives; `accept` keeps it, `reject` goes back. Both proposals are symmetric: a large step draws all numbers
/// anew, a small one moves each by a normal deviate, on the circle of [0, 1). Numbers that a path did not ask for in some
/// iterations are moved as often as they were left out, when they are asked for again. One for each chain, and one thread at a
/// time: asking draws. SampleKey::sample does not count, so that one key serves the whole chain.
class MutatedNumbers final : public NumberSource {
 public:
  /// `deviation`: of a small step.
  explicit MutatedNumbers(std::uint64_t seed, float deviation = 0.01f) : seed_(seed), deviation_(deviation) {}

  void large_step() { begin(true); }
  void small_step() { begin(false); }
  void accept();
  void reject();

  float number(SampleKey, std::uint32_t dimension) const override;
  Point2 pair(SampleKey, std::uint32_t dimension) const override;

  /// The state between two proposals, for RenderProcess::save_state: appends to `to`; the same states give the same bytes.
  void save(std::vector<std::byte>& to) const;
  /// Takes it over from the beginning of `from`, and takes that off. Throws Error when it is none.
  void load(std::span<const std::byte>& from);

 private:
  struct Coordinate {
    float value = 0, before = 0;
    std::uint64_t changed = 0, changed_before = 0;  ///< iterations; 0: never
  };
  void begin(bool large);
  float draw() const;

  std::uint64_t seed_;
  float deviation_;
  std::uint64_t iteration_ = 1, last_large_ = 1;  ///< the first state is drawn as a whole
  bool large_ = true;
  mutable std::uint64_t drawn_ = 0;
  mutable std::unordered_map<std::uint64_t, std::vector<Coordinate>> walks_;
  mutable std::vector<std::pair<std::uint64_t, std::uint32_t>> touched_;  ///< in this iteration
};

}  // namespace etendue
