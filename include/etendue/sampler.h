#pragma once
// Sampler: numbers in [0, 1) by walk, sample and dimension.

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/numbers.h"

namespace etendue {

/// Stateless: the same arguments give the same numbers, from any thread.
class Sampler : public Component, public NumberSource {
 public:
  using Interface = Sampler;
  using Parent = Component;
  static void describe(Description<Sampler>&);
};

}  // namespace etendue
