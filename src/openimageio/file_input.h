#pragma once
// Reads whole image files without conversion.

#include "images/image_library.h"

namespace etendue {

/// See ImageLibrary::read.
StoredImage read_file(const std::string& path);

}  // namespace etendue
