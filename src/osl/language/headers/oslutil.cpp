// oslutil.h: what it declares is refused.

#include "headers.h"

namespace etendue::osl {

// The header declares nothing: wireframe() and draw_string() are rows of the library's table, which say why they are refused
// (library/world.cpp).
std::string oslutil_header() { return "#pragma once\n#define OSLUTIL_H\n"; }

}  // namespace etendue::osl
