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

inline constexpr const char* udim_mark = "<UDIM>";
struct UdimFile {
  int u, v;  ///< the unit square the image covers begins at (u, v)
  std::string path;
};
/// The files that a path with "<UDIM>" in its name stands for: there are numbers 1001 + u + 10 v in its place, u from 0 to 9.
std::vector<UdimFile> udim_files(const std::string& pattern);

}  // namespace etendue
