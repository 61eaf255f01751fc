#pragma once
// Between our pictures and the image library: files are made in memory and then written whole.

#include <string>

#include "images/image_library.h"

namespace etendue {

/// Encodes pixels in the format of an ending (".png") and writes the file whole.
void write_encoded(const std::string& path, const std::string& extension, const ImageHeader&, const PixelValues&);

/// Writes R, G and B of a tone mapped picture as whole numbers of 8 or 16 bits, rounded; other channels are left out.
/// With `dither`, noise between -1/2 and 1/2 steps, a function of the pixel alone, is added before.
void write_display_image(const Image&, const std::string& path, const std::string& extension, int bits, bool dither);

}  // namespace etendue
