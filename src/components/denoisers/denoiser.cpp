#include "etendue/denoiser.h"

namespace etendue {

void Denoiser::describe(Description<Denoiser>& d) {
  d.summary(
       "Makes of the finished picture a second one with less noise, which is written beside each output as "
       "NAME.denoised.ENDING. It is biased: what looks like noise is smoothed, and may have been light. The picture itself "
       "stays as it is.")
      .member<&Denoiser::guide_samples>(
          "guide_samples", "1",
          "samples per pixel of the guides, by which edges are told from noise: colour and normal of the first surface that is "
          "no mirror and no clear glass, along camera rays of their own; 0: no guides",
          range(0, 65536), soft(0, 64), Effect::retone);
}

static const Register<Denoiser> registered;

}  // namespace etendue
