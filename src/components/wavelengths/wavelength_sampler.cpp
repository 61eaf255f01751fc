#include "etendue/wavelength_sampler.h"

namespace etendue {

void WavelengthSampler::describe(Description<WavelengthSampler>& d) {
  d.summary("Chooses the wavelengths of a path and their densities per nanometre.");
}

static const Register<WavelengthSampler> registered;

}  // namespace etendue
