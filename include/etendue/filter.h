#pragma once
// Filter: the reconstruction filter of the film (Filter in pbrt, ReconstructionFilter in Mitsuba): the weight of a sample for a
// pixel, by its offset from the pixel's centre.
//
// A new filter must implement `weight` and `radius`.

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

class Filter : public Component {
 public:
  using Interface = Filter;
  using Parent = Component;
  static void describe(Description<Filter>&);

  /// The weight at an offset [pixels]; zero beyond the radius. It need not be normalized: the film divides by its integral.
  virtual float weight(float x, float y) const = 0;
  /// Half the width of the support [pixels].
  virtual float radius() const = 0;
};

}  // namespace etendue
