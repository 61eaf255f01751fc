#pragma once
// OpenImageIO's cache of image tiles.

#include <OpenImageIO/imagecache.h>

namespace etendue {

/// One cache for all maps, alive until the program ends.
OIIO::ImageCache& image_cache();

}  // namespace etendue
