#pragma once
// PhaseFunction (of the same name in pbrt and Mitsuba): the distribution of the scattering angle in a medium.
//
// A new phase function must implement `value` and `sample`.

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// For randomly oriented particles, whose scattering depends on the scattering angle theta alone. The angle is given as h = 1 -
/// cos(theta), from 0 (forward) to 2 (backward), because a narrow forward peak is resolved by floats of h, but not by floats of
/// the cosine near 1.
class PhaseFunction : public Component {
 public:
  using Interface = PhaseFunction;
  using Parent = Component;
  static void describe(Description<PhaseFunction>&);

  /// The pdf of the direction [1/sr]. It integrates to 1 over all directions. As the solid angle element is 2 pi dh,
  ///     2 pi int_0^2 value(h) dh = 1.
  virtual float value(float h) const = 0;
  /// Samples h by a number u that is uniform between 0 and 1, exactly in proportion to `value`: with the pdf 2 pi value(h) of
  /// h.
  virtual float sample(float u) const = 0;
};

}  // namespace etendue
