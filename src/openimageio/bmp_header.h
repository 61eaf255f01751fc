#pragma once

#include <string>

namespace etendue {

/// Checks that a BMP file's way of packing is one that goes with its bits per pixel, and that its pixels begin within it: the
/// library's reader takes that for granted. Throws Error with the reason alone. What does not begin as a BMP file passes.
void check_bmp_header(const std::string& path);

}  // namespace etendue
