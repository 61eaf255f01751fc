#pragma once
// Renderers with one fault each, of the kind that gives plausible images: `verify` must find every fault.

#include "etendue/render/renderer.h"

namespace etendue {

enum class Fault : std::uint8_t {
  none,
  wrong_mis_weight,       ///< the square root of the weight of the power heuristic
  no_squared_index,       ///< radiance is not changed by refraction
  lost_cosine,            ///< of next event estimation
  wrong_measure,          ///< of next event estimation: a factor of the distance too many
  roulette_undivided,     ///< survivors are not divided by the survival probability
  luminaire_twice,        ///< emitter hits count in full, in addition to next event estimation
  lens_importance,        ///< of light tracing: one cosine of the camera too many
  phase_pdf,              ///< phase functions are importance sampled, but weighted with the uniform pdf
  transmittance_squared,  ///< of shadow rays
  skipped_length,         ///< no paths of exactly four segments
  acceptance_inverted,    ///< of chains: accepted with I(u) / I(v)
  no_expected_values,     ///< the state before a proposal is not added with its weight 1 - a
  large_steps_twice,      ///< large steps are also added in full as independent samples
  direct_light_twice,     ///< chains carry direct light, which is also sampled separately
  guide_pdf,              ///< the guide's pdf is missing in the pdf of the mixture
  merging_unweighted,     ///< photons count in full, in addition to connections
  kernel_not_shrunk,      ///< photons within the shrunk radius are divided by the area of the first radius
  dark_paths_left_out,    ///< of chains: brightness is the mean over paths that are not black
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
