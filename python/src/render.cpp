// Renders.

#include "binding.h"

namespace etendue::python {

void bind_render(nb::module_&) {}

}  // namespace etendue::python
