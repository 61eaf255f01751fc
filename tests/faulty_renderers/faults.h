#pragma once
// Renderers with one fault each of the kind that gives plausible pictures: `verify` must find it.

#include "etendue/render/renderer.h"

namespace etendue {

enum class Fault : std::uint8_t {
  none,
  wrong_mis_weight,       ///< the other strategy's density enters unsquared
  no_squared_index,       ///< radiance is not changed by refraction
  lost_cosine,            ///< where luminaires are sampled
  wrong_measure,          ///< a distance too many where luminaires are sampled
  roulette_undivided,     ///< survivors are not made up for those that ended
  luminaire_twice,        ///< met luminaires count in full beside sampled ones
  lens_importance,        ///< of light tracing: one cosine of the camera too many
  phase_pdf,              ///< phase functions sampled as they are, weighted as if uniform
  transmittance_squared,  ///< on the way to luminaires
  skipped_length,         ///< no paths of exactly four segments
  acceptance_inverted,    ///< of chains: accepted with I(u) / I(v)
  no_expected_values,     ///< states are not added again when a proposal is rejected
  large_steps_twice,      ///< large steps count as independent samples, beside all that chains find
  direct_light_twice,     ///< chains carry what is sampled apart
  guide_pdf,              ///< directions that a guide chooses are weighted as if scattering had chosen them
  merging_unweighted,     ///< photons count in full beside connections
  kernel_not_shrunk,      ///< photons are looked for within the shrunk radius, and divided by the first one's area
  dark_paths_left_out,    ///< of chains: brightness is the mean over the paths that bring any light
};

template <auto member, class R>
void describe_fault(Description<R>& d) {
  d.template member<member>(
      "fault", "", "what is wrong",
      choices("none", "wrong_mis_weight", "no_squared_index", "lost_cosine", "wrong_measure", "roulette_undivided",
              "luminaire_twice", "lens_importance", "phase_density", "transmittance_squared", "skipped_length",
              "acceptance_inverted", "no_expected_values", "large_steps_twice", "direct_light_twice", "guide_density",
              "merging_unweighted", "kernel_not_shrunk", "dark_paths_left_out"));
}

}  // namespace etendue
