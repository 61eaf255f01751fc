#pragma once

#include <string>

namespace etendue {

/// Checks that a PNG file holds as many bytes as its pieces claim, before a library takes memory for them. Throws Error with
/// the reason alone. What does not begin as a PNG file passes.
void check_png_chunks(const std::string& path);

}  // namespace etendue
