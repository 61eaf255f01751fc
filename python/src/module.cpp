// The extension module etendue._core: the library as Python sees it. The package's Python files make it comfortable.

#include "binding.h"

NB_MODULE(_core, m) {
  using namespace etendue::python;
  m.doc() = "The compiled part of the package etendue; use the package instead.";
  m.attr("__version__") = ETENDUE_VERSION;
  bind_errors(m);
  bind_values(m);
  bind_components(m);
  bind_language(m);
  bind_images(m);
  bind_render(m);
  bind_laboratory(m);
  // The interpreter may end while parts, pictures and classes are still referred to: that is no leak worth a message.
  nb::set_leak_warnings(false);
}
