#pragma once
// Denoiser: makes of a finished picture one with less noise, at the price of a bias.

#include "etendue/core/image.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

class Denoiser : public Component {
 public:
  using Interface = Denoiser;
  using Parent = Component;
  static void describe(Description<Denoiser>&);

  /// Samples per pixel of the guides: what is seen in each pixel beside its light, by which edges are told from noise.
  /// 0: none are made.
  int guide_samples = 16;

  /// Throws Error, at the place where it was written, when it cannot work here, and says what would help. Asked before
  /// anything is rendered.
  virtual void require() const {}
  /// What does the work, with its version: for the texts of the picture.
  virtual std::string worker() const = 0;

  /// The picture with other values of X, Y, Z; all else stays. `guides`: of the same size, with the channels "albedo.R", ".G",
  /// ".B" (linear sRGB) and "normal.X", ".Y", ".Z" (unit vectors, means of them in [-1, 1], or zero); or without channels.
  /// Values that are not finite count as zero. `threads`: 0 for all cores.
  virtual Image denoised(const Image& picture, const Image& guides, int threads) const = 0;
};

}  // namespace etendue
