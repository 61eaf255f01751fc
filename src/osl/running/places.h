#pragma once
// Places in shaders' files, as messages name them.

#include <string>

#include "etendue/core/error.h"

namespace etendue::osl {

/// "marble.osl:12": the file's name without its folder, and the line.
std::string place_text(const Location&);

}  // namespace etendue::osl
