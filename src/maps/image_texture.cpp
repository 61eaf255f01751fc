#include "maps/image_texture.h"

#include <OpenImageIO/imagecache.h>

#include <mutex>

#include "etendue/error.h"
#include "maps/linear_image.h"

namespace etendue {

OIIO::TextureSystem& textures() {
  static OIIO::TextureSystem* const system = [] {
    OIIO::TextureSystem* s = OIIO::TextureSystem::create(false);
    s->attribute("autotile", 64);
    s->attribute("automip", 1);
    s->attribute("accept_untiled", 1);
    s->attribute("accept_unmipped", 1);
    s->attribute("max_memory_MB", 2048.0f);
    return s;
  }();
  return *system;
}

ImageTexture open_texture(const std::string& path, const std::string& transfer, const std::string& channel) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  OIIO::TextureSystem& system = textures();
  OIIO::ImageCache& cache = *system.imagecache();
  const OIIO::ustring key(linear_image_key(path, transfer, channel));
  const auto refuse = [&] {
    // OpenImageIO's message names our key; the path is what the user knows.
    std::string reason = system.geterror();
    if (reason.empty()) reason = cache.geterror();
    for (size_t at; (at = reason.find(key.string())) != std::string::npos;) reason.replace(at, key.string().size(), path);
    while (!reason.empty() && (reason.back() == '\n' || reason.back() == ' ')) reason.pop_back();
    cache.invalidate(key);
    throw Error("cannot read '" + path + "': " + (reason.empty() ? "it is no image" : reason));
  };
  if (!cache.add_file(key, make_linear_input)) refuse();
  OIIO::ImageSpec spec;
  if (!cache.get_imagespec(key, spec)) refuse();
  constexpr int rows = 64;
  std::vector<float> strip(size_t(spec.width) * rows * size_t(spec.nchannels));
  for (int y = 0; y < spec.height; y += rows)
    if (!cache.get_pixels(key, 0, 0, spec.x, spec.x + spec.width, spec.y + y, spec.y + std::min(y + rows, spec.height), 0, 1,
                          OIIO::TypeDesc::FLOAT, strip.data()))
      refuse();
  ImageTexture texture{system.get_texture_handle(key), spec.nchannels};
  if (!texture.handle || !system.good(texture.handle)) refuse();
  return texture;
}

}  // namespace etendue
