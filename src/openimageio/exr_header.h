#pragma once

#include <string>

namespace etendue {

/// Checks what an OpenEXR file says of itself against what it can hold, before a library takes memory for it. Throws Error with
/// the reason alone. What does not begin as an OpenEXR file passes. Whether its first image is one of surroundings on the faces
/// of a cube (its attribute `envmap`).
bool check_exr_header(const std::string& path);

}  // namespace etendue
