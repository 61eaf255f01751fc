#pragma once
// A made-up material in the RGL material database's format.

#include <string>

namespace etendue::conform {

/// The bytes of a tensor file: an isotropic, rough and greyish surface.
std::string rgl_material();

}  // namespace etendue::conform
