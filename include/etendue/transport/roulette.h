#pragma once
// Russian roulette (Arvo & Kirk 1990, "Particle transport and image synthesis").

#include <algorithm>
#include <utility>

namespace etendue {

/// Ends walks with a small throughput at random. A walk that survives with probability q is divided by q, so the mean of the
/// throughput is unchanged. q is the throughput relative to the initial one (Walk::roulette_weight), at most 1. The pending
/// survival probability of a branch of a split walk (Walk::pending_survival) is applied as well.
struct Roulette {
  int depth = 5;  ///< segments before it may end a walk

  /// False: the walk ends. Takes a random number only if q may be below 1. `roulette_weight` replaces that of the walk.
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
