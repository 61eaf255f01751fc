#pragma once
// Writing of images with the image library: files are encoded in memory and then written as a whole (files/whole_file.h).

#include <string>

#include "images/image_library.h"

namespace etendue {

/// Encodes pixels in the format of a file extension (".png") and writes the file as a whole.
void write_encoded(const std::string& path, const std::string& extension, const ImageHeader&, const PixelValues&);

/// Writes R, G and B of a tone mapped image as integers of 8 or 16 bits, rounded; other channels are omitted. With `dither`,
/// noise between -1/2 and 1/2 steps, a function of the pixel alone, is added before rounding.
void write_display_image(const Image&, const std::string& path, const std::string& extension, int bits, bool dither);

}  // namespace etendue
