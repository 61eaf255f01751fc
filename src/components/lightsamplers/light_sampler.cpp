// The description of LightSampler, the base class of all light samplers; it has no members.

#include "etendue/light_sampler.h"

namespace etendue {

void LightSampler::describe(Description<LightSampler>& d) { d.summary("Chooses the luminaire that is asked for light."); }

static const Register<LightSampler> registered;

}  // namespace etendue
