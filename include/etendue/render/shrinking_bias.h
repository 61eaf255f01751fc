#pragma once
// ShrinkingBias: what a consistent algorithm can say of how its bias goes away.

#include <cstdint>

namespace etendue {

/// A Renderer that is consistent because each step has less bias than the one before may be this as well:
///
///     class PhotonMapper final : public Renderer, public ShrinkingBias { … };
///
/// `etendue verify` then tells from the steps what its mean goes to, and at what rate (docs/verify.md).
class ShrinkingBias {
 public:
  /// How wide the blur of a step is, or whatever else its bias is made by, over that of the first step (number 0): r_i / r_1 of
  /// a photon map with the radii r_i. The bias of a step is taken to fall at least as w and at most as w^2. A function of the
  /// step and the members alone. Not positive: with these members there is no such bias, or it does not shrink.
  virtual double bias_width(std::uint32_t step) const = 0;

 protected:
  ~ShrinkingBias() = default;
};

}  // namespace etendue
