#pragma once

#include <string>

namespace etendue {

/// Checks that a BMP file's compression is valid for its bits per pixel, and that its pixels begin within the file, neither of
/// which OpenImageIO's reader checks. Throws Error with the reason, without the path. Other files pass.
void check_bmp_header(const std::string& path);

}  // namespace etendue
