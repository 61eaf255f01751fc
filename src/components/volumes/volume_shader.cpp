// What all participating media have in common: they have no members of their own.

#include "etendue/volume_shader.h"

namespace etendue {

void VolumeShader::describe(Description<VolumeShader>& d) {
  d.summary("How the inside of an object absorbs, scatters and emits light (a participating medium).");
}

static const Register<VolumeShader> registered;

}  // namespace etendue
