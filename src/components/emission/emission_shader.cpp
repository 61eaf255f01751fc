// The description of the member that all emission shaders have: the sides that emit.

#include "etendue/emission_shader.h"

namespace etendue {

void EmissionShader::describe(Description<EmissionShader>& d) {
  d.summary("How light leaves a luminaire.")
      .member<&EmissionShader::sides>("sides", "", "which sides of the surface emit light", choices("front", "back", "both"));
}

static const Register<EmissionShader> registered;

}  // namespace etendue
