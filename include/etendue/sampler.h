#pragma once
// Sampler (of the same name in pbrt and Mitsuba): generates primary samples, the random or low-discrepancy numbers in [0, 1)
// from which paths are made, as a function of the walk, the sample index and the dimension.
//
// A new sampler must implement `number` and `pair` of NumberSource (numbers.h). Optional: `two_pairs` for speed.

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/numbers.h"

namespace etendue {

/// Samplers have no state, unlike in pbrt and Mitsuba: the same arguments give the same numbers, from any thread.
class Sampler : public Component, public NumberSource {
 public:
  using Interface = Sampler;
  using Parent = Component;
  static void describe(Description<Sampler>&);
};

}  // namespace etendue
