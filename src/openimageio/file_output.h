#pragma once
// Encodes image files in memory.

#include "images/image_library.h"

namespace etendue {

/// See ImageLibrary::encode.
std::vector<unsigned char> encode_file(const std::string& extension, const ImageHeader&, const PixelValues&);

}  // namespace etendue
