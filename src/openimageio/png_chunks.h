#pragma once

#include <string>

namespace etendue {

/// Checks that a PNG file contains as many bytes as its chunks claim, before a library allocates memory for them. Throws Error
/// with the reason, without the path. Other files pass.
void check_png_chunks(const std::string& path);

}  // namespace etendue
