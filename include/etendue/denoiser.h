#pragma once
// Denoiser (of the same name in pbrt; OptixDenoiser in Mitsuba): computes from a finished image one with less noise, at the
// price of bias.
//
// A new denoiser must implement `denoised` and `worker`. Optional: `require`.

#include "etendue/core/image.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

class Denoiser : public Component {
 public:
  using Interface = Denoiser;
  using Parent = Component;
  static void describe(Description<Denoiser>&);

  /// Samples per pixel of the guides: auxiliary images of albedo and normal, by which edges are distinguished from noise. 0: no
  /// guides.
  int guide_samples = 16;

  /// Throws Error, with the component's location and a remedy, if the denoiser cannot work on this machine. Called before
  /// rendering.
  virtual void require() const {}
  /// The name and version of the library that denoises, for the metadata of the image.
  virtual std::string worker() const = 0;

  /// The image with denoised values of X, Y, Z; everything else is unchanged. `guides` has the same size, and the channels
  /// "albedo.R", ".G", ".B" (linear sRGB) and "normal.X", ".Y", ".Z" (unit vectors, means of them in [-1, 1], or zero), or no
  /// channels. Values that are not finite count as zero. `threads`: 0 for all cores.
  virtual Image denoised(const Image& picture, const Image& guides, int threads) const = 0;
};

}  // namespace etendue
