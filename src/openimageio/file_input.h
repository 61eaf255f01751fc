#pragma once
// Whole image files as they are.

#include "images/image_library.h"

namespace etendue {

/// See ImageLibrary::read.
StoredImage read_file(const std::string& path);

}  // namespace etendue
