// The base class Shader: it has no members of its own.

#include "etendue/shader.h"

namespace etendue {

void Shader::describe(Description<Shader>& d) { d.summary("How a surface scatters light (a material)."); }

static const Register<Shader> registered;

}  // namespace etendue
