// The description of VolumeShader, the base class of all participating media; it has no members.

#include "etendue/volume_shader.h"

namespace etendue {

void VolumeShader::describe(Description<VolumeShader>& d) {
  d.summary("How the inside of an object absorbs, scatters and emits light (a participating medium).");
}

static const Register<VolumeShader> registered;

}  // namespace etendue
