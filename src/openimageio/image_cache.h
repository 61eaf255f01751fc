#pragma once
// OpenImageIO's cache of image tiles.

#include <OpenImageIO/imagecache.h>

namespace etendue {

/// The cache shared by all textures, which lives until the program ends.
OIIO::ImageCache& image_cache();

}  // namespace etendue
