// The description of Sampler, the base class of all samplers; it has no members.

#include "etendue/sampler.h"

namespace etendue {

void Sampler::describe(Description<Sampler>& d) {
  d.summary("Gives the numbers in [0, 1) a path is built from, by pixel, sample and dimension.");
}

static const Register<Sampler> registered;

}  // namespace etendue
