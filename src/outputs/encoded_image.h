#pragma once
// Between our pictures and the image library: files are made in memory and then written whole.

#include <OpenImageIO/imageio.h>

#include <string>

#include "etendue/image.h"

namespace etendue {

/// The picture's metadata as attributes of a file.
void add_metadata(OIIO::ImageSpec&, const Image&);

/// Encodes pixels of the given type in the format of an ending (".png") and writes the file whole.
void write_encoded(const std::string& path, const std::string& extension, const OIIO::ImageSpec&, OIIO::TypeDesc,
                   const void* pixels);

/// Writes R, G and B of a tone mapped picture as whole numbers of 8 or 16 bits, rounded; other channels are left out.
/// With `dither`, noise between -1/2 and 1/2 steps, a function of the pixel alone, is added before.
void write_display_image(const Image&, const std::string& path, const std::string& extension, int bits, bool dither);

}  // namespace etendue
