#pragma once
// Sources of primary samples that are recorded or mutated: for Metropolis light transport in primary sample space, and for
// replays of a path.

#include <cstddef>
#include <span>
#include <unordered_map>
#include <vector>

#include "etendue/numbers.h"

namespace etendue {

/// Records the numbers that another source returns for one sample: a repeated request returns the same number, even if the
/// other source has been destroyed or has changed.
class RecordedPrimarySamples final : public NumberSource {
 public:
  explicit RecordedPrimarySamples(const NumberSource& source) : source_(&source) {}
  /// Detaches the source: numbers that were not recorded are 0.5 from now on.
  void close() { source_ = nullptr; }

  float number(SampleKey, std::uint32_t dimension) const override;
  Point2 pair(SampleKey, std::uint32_t dimension) const override;

 private:
  const NumberSource* source_;
  mutable std::unordered_map<std::uint64_t, std::unordered_map<std::uint32_t, float>> walks_;
};

/// The state of a Markov chain in primary sample space (Kelemen, Szirmay-Kalos, Antal & Csonka 2002, "A simple and robust
/// mutation strategy for the Metropolis light transport algorithm"). `large_step` and `small_step` propose a new state, whose
/// numbers the source then returns; `accept` keeps it, `reject` returns to the old one. Both proposals are symmetric: a large
/// step draws all numbers anew, a small step adds a normal deviate to each, on the circle of [0, 1). A number that was not used
/// in some iterations gets the small steps that it missed when it is used again; its value after them is part of the current
/// state, whether or not the proposal is accepted. One object per chain, used by one thread at a time: requests draw random
/// numbers. SampleKey::sample is ignored, so that one key serves the whole chain.
class MutatedPrimarySamples final : public NumberSource {
 public:
  explicit MutatedPrimarySamples(std::uint64_t seed) : seed_(seed) {}
  MutatedPrimarySamples(const MutatedPrimarySamples&) = delete;  // last_ points to a member of walks_
  MutatedPrimarySamples& operator=(const MutatedPrimarySamples&) = delete;

  void large_step() { begin(true, 1); }
  /// `deviation`: the standard deviation of the change of each number. It may differ from step to step, but must not depend on
  /// the state.
  void small_step(float deviation = 0.01f) { begin(false, double(deviation) * double(deviation)); }
  void accept();
  void reject();

  float number(SampleKey, std::uint32_t dimension) const override;
  Point2 pair(SampleKey, std::uint32_t dimension) const override;

  /// The state between two proposals, for RenderProcess::save_state. Appends to `to`; equal states give equal bytes.
  void save(std::vector<std::byte>& to) const;
  /// Reads the state from the front of `from`, and removes it there. Throws Error if the bytes are not a state.
  void load(std::span<const std::byte>& from);

 private:
  /// Time is the sum of the variances of the small steps so far. The time of the last change of a number gives the variance of
  /// the steps that it missed.
  struct Coordinate {
    float value = 0, before = 0;
    double changed = 0, changed_before = 0;  ///< times; 0: never
  };
  using Walk = std::vector<Coordinate>;
  void begin(bool large, double variance);
  float draw() const;
  Walk& walk(std::uint64_t name) const;
  /// Two independent normal deviates of variance 1.
  Point2 normal_pair() const;
  /// Applies the small steps between the last change of a number and `time`.
  static void move(Coordinate&, double time, float normal);
  /// The number in the proposed state. `normal` is called for a deviate if the number is mutated by a small step.
  template <class Normal>
  float proposed(Walk&, std::uint32_t dimension, const Normal& normal) const;

  std::uint64_t seed_;
  double time_ = 1, time_before_ = 1, last_large_ = 1;  ///< the first state is drawn as by a large step
  bool large_ = true;
  mutable std::uint64_t drawn_ = 0;
  mutable std::unordered_map<std::uint64_t, Walk> walks_;
  mutable std::uint64_t last_name_ = 0;  ///< of the walk of the last request
  mutable Walk* last_ = nullptr;
  mutable std::vector<std::pair<Walk*, std::uint32_t>> touched_;  ///< the numbers that this proposal changed
};

}  // namespace etendue
