// Pictures as arrays.

#include "binding.h"

namespace etendue::python {

void bind_images(nb::module_&) {}

}  // namespace etendue::python
