// Images of models: those that cannot be read are left out, for a model is better seen without than not at all.

#include <algorithm>

#include "images/linear_image.h"
#include "surface.h"

namespace etendue {

std::optional<SurfaceTexture> readable_texture(Importing& importing, const std::string& file, Location at, bool* has_alpha) {
  try {
    const std::vector<std::string>& channels = importing.image_channels(file);
    if (has_alpha) *has_alpha = std::ranges::count(channels, "A") > 0;
    SurfaceTexture texture;
    texture.file = file;
    return texture;
  } catch (const Error& error) {
    importing.inexact(std::string("the image is left out: ") + error.what(), at);
    return std::nullopt;
  }
}

bool looks_like_normals(const std::string& file) {
  LinearImage image;
  try {
    image = read_linear_image(file, "linear");
  } catch (const Error&) {
    return false;  // what is damaged behind its header is told where the map opens it
  }
  double r = 0, g = 0, b = 0;
  const size_t pixels = image.rgb.size() / 3, step = std::max<size_t>(pixels / 10000, 1);
  size_t count = 0;
  for (size_t i = 0; i < pixels; i += step, ++count) {
    r += double(image.rgb[3 * i]);
    g += double(image.rgb[3 * i + 1]);
    b += double(image.rgb[3 * i + 2]);
  }
  const double n = double(std::max<size_t>(count, 1));
  return std::abs(r / n - 0.5) < 0.1 && std::abs(g / n - 0.5) < 0.1 && b / n > 0.7;
}

}  // namespace etendue
