// What all light samplers have in common: they have no members of their own.

#include "etendue/light_sampler.h"

namespace etendue {

void LightSampler::describe(Description<LightSampler>& d) { d.summary("Chooses the luminaire that is asked for light."); }

static const Register<LightSampler> registered;

}  // namespace etendue
