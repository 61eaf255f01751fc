// Images of models: those that cannot be read are left out, for a model is better seen without than not at all.

#include <algorithm>

#include "images/linear_image.h"
#include "surface.h"

namespace etendue {

std::optional<SurfaceTexture> readable_texture(Importing& importing, const std::string& file, Location at, bool* has_alpha) {
  try {
    const std::vector<std::string> channels = image_channels(file);
    if (has_alpha) *has_alpha = std::ranges::count(channels, "A") > 0;
    SurfaceTexture texture;
    texture.file = file;
    return texture;
  } catch (const Error& error) {
    importing.inexact(std::string("the image is left out: ") + error.what(), at);
    return std::nullopt;
  }
}

}  // namespace etendue
