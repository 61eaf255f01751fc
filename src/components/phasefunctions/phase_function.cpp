// The description of PhaseFunction, the base class of all phase functions; it has no members.

#include "etendue/phase_function.h"

namespace etendue {

void PhaseFunction::describe(Description<PhaseFunction>& d) {
  d.summary("Where light goes that a medium scatters, by the angle it turns by.");
}

static const Register<PhaseFunction> registered;

}  // namespace etendue
