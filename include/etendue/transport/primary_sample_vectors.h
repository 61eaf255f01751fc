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
class RecordedPrimarySamples final : public NumberSource {
 public:
  explicit RecordedPrimarySamples(const NumberSource& source) : source_(&source) {}
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
/// iterations are moved as often as they were left out, when they are asked for again; where that puts them is part of the
/// state from then on, whether or not the proposal is accepted. One for each chain, and one thread at a time: asking draws.
/// SampleKey::sample does not count, so that one key serves the whole chain.
class MutatedPrimarySamples final : public NumberSource {
 public:
  explicit MutatedPrimarySamples(std::uint64_t seed) : seed_(seed) {}
  MutatedPrimarySamples(const MutatedPrimarySamples&) = delete;  // it points into itself
  MutatedPrimarySamples& operator=(const MutatedPrimarySamples&) = delete;

  void large_step() { begin(true, 1); }
  /// `deviation`: the standard deviation of each number. It may differ from step to step, but must not depend on the state.
  void small_step(float deviation = 0.01f) { begin(false, double(deviation) * double(deviation)); }
  void accept();
  void reject();

  float number(SampleKey, std::uint32_t dimension) const override;
  Point2 pair(SampleKey, std::uint32_t dimension) const override;

  /// The state between two proposals, for RenderProcess::save_state: appends to `to`; the same states give the same bytes.
  void save(std::vector<std::byte>& to) const;
  /// Takes it over from the beginning of `from`, and takes that off. Throws Error when it is none.
  void load(std::span<const std::byte>& from);

 private:
  /// Time is counted in the variance of the small steps so far, so that numbers left out know how far they are to be moved.
  struct Coordinate {
    float value = 0, before = 0;
    double changed = 0, changed_before = 0;  ///< when; 0: never
  };
  using Walk = std::vector<Coordinate>;
  void begin(bool large, double variance);
  float draw() const;
  Walk& walk(std::uint64_t name) const;
  /// Two normal deviates of variance 1.
  Point2 normal_pair() const;
  /// Moves it from where it stood to where it stands at `time`.
  static void move(Coordinate&, double time, float normal);
  /// The coordinate as the proposal has it, of which `normal` is used where it is moved.
  template <class Normal>
  float proposed(Walk&, std::uint32_t dimension, const Normal& normal) const;

  std::uint64_t seed_;
  double time_ = 1, time_before_ = 1, last_large_ = 1;  ///< the first state is drawn as a whole
  bool large_ = true;
  mutable std::uint64_t drawn_ = 0;
  mutable std::unordered_map<std::uint64_t, Walk> walks_;
  mutable std::uint64_t last_name_ = 0;  ///< of the walk that was asked for last
  mutable Walk* last_ = nullptr;
  mutable std::vector<std::pair<Walk*, std::uint32_t>> touched_;  ///< by this proposal
};

}  // namespace etendue
