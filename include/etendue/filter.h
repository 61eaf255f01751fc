#pragma once
// Filter: how much a sample counts for a pixel, by its offset from the pixel's centre.

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

class Filter : public Component {
 public:
  using Interface = Filter;
  using Parent = Component;
  static void describe(Description<Filter>&);

  /// Weight at an offset [pixels]; zero beyond the radius. Need not be normalized: the film divides by the sum.
  virtual float weight(float x, float y) const = 0;
  /// Half the width of the support [pixels].
  virtual float radius() const = 0;
};

}  // namespace etendue
