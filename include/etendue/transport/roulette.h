#pragma once
// Russian roulette (Arvo & Kirk 1990, "Particle transport and image synthesis").

#include <algorithm>
#include <utility>

namespace etendue {

/// Ends walks that carry little, and lets others carry more: one that survives with probability q is divided by q, so what all
/// walks carry together has the same mean. q is what is left of what the walk began with (Walk::left). What a branch of a
/// divided walk is due (Walk::due) comes to that.
struct Roulette {
  int depth = 5;  ///< segments before it may end a walk

  /// False: the walk ends. Takes a number only where there is a choice. `left`: what counts as left of the walk.
  template <class Walk>
  bool survives(Walk& walk) const {
    return survives(walk, walk.roulette_weight());
  }
  template <class Walk>
  bool survives(Walk& walk, float roulette_weight) const {
    if (walk.length >= depth) {
      const float survival = std::min(1.0f, roulette_weight);
      if (walk.numbers.next() >= survival) return false;
      walk.throughput /= survival;
    }
    if (walk.pending_survival < 1) [[unlikely]] {
      const float part = std::exchange(walk.pending_survival, 1.0f);
      if (walk.numbers.next() >= part) return false;
      walk.throughput /= part;
    }
    return !walk.throughput.black();
  }
};

}  // namespace etendue
