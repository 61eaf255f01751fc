#pragma once
// PhaseFunction: where light goes that a medium scatters, by the angle it turns by.

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// Of particles that lie in all directions alike: what counts is the angle theta that light turns by, given as h = 1 -
/// cos(theta), from 0 (straight on) to 2 (back). A narrow peak straight on has its digits in h, where those of the cosine are
/// lost.
class PhaseFunction : public Component {
 public:
  using Interface = PhaseFunction;
  using Parent = Component;
  static void describe(Description<PhaseFunction>&);

  /// Probability density of the direction [1/sr]. It integrates to 1 over all directions: as a solid angle is 2 pi dh,
  ///     2 pi int_0^2 value(h) dh = 1.
  virtual float value(float h) const = 0;
  /// An h drawn from a number that is uniform between 0 and 1, exactly in proportion to `value`: with the density
  /// 2 pi value(h) over h.
  virtual float sample(float u) const = 0;
};

}  // namespace etendue
