#pragma once

#include <string>

namespace etendue {

/// Checks the claims of an OpenEXR file's header against its size, before a library allocates memory for them. Throws Error
/// with the reason, without the path. Other files pass. Returns whether the first image is an environment map on the faces of a
/// cube (attribute `envmap`).
bool check_exr_header(const std::string& path);

}  // namespace etendue
