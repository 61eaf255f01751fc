#pragma once
// Image files in OpenImageIO's cache of textures.

#include <OpenImageIO/texture.h>

#include <string>
#include <vector>

namespace etendue {

/// A file that textures can be looked up in.
struct ImageTexture {
  OIIO::TextureSystem::TextureHandle* handle = nullptr;
  int channels = 3;  ///< 3 or 1
};

/// One cache of image tiles for all maps, alive until the program ends.
OIIO::TextureSystem& textures();

/// Reads a whole file once, so that a damaged one is found before rendering. Throws Error naming the file and the reason.
ImageTexture open_texture(const std::string& path, const std::string& transfer, const std::string& channel);

}  // namespace etendue
