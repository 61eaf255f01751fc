#pragma once
// ShrinkingBias: how the bias of a consistent algorithm decreases from step to step.

#include <cstdint>

namespace etendue {

/// A Renderer that is consistent because the bias decreases with each step may also derive from this class:
///
///     class PhotonMapper final : public Renderer, public ShrinkingBias { … };
///
/// `etendue verify` then estimates from the steps the limit of the mean and its rate of convergence (docs/verify.md).
class ShrinkingBias {
 public:
  /// The width w of a step's blur, or of another cause of its bias, relative to the first step (number 0): r_i / r_1 for a
  /// photon map with the radii r_i. The bias of a step is assumed to fall at least as w and at most as w^2. Depends on the step
  /// and the members alone. Not positive: with these members there is no such bias, or it does not shrink.
  virtual double bias_width(std::uint32_t step) const = 0;

 protected:
  ~ShrinkingBias() = default;
};

}  // namespace etendue
