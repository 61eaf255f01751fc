#include "maps/image_texture.h"

#include <OpenImageIO/imagecache.h>

#include <charconv>
#include <filesystem>
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

std::vector<UdimFile> udim_files(const std::string& pattern) {
  const std::filesystem::path whole(pattern);
  const std::string name = whole.filename().string();
  const size_t mark = name.find(udim_mark);
  std::vector<UdimFile> files;
  if (mark == std::string::npos) return files;
  const std::string before = name.substr(0, mark), after = name.substr(mark + std::string_view(udim_mark).size());
  const std::filesystem::path folder = whole.has_parent_path() ? whole.parent_path() : std::filesystem::path(".");
  std::error_code error;
  for (std::filesystem::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    const std::string found = i->path().filename().string();
    constexpr size_t digits = 4;
    if (found.size() != before.size() + digits + after.size() || !found.starts_with(before) || !found.ends_with(after))
      continue;
    const char* const begin = found.data() + before.size();
    int number = 0;
    const auto [stop, code] = std::from_chars(begin, begin + digits, number);
    if (code != std::errc() || stop != begin + digits || number < 1001) continue;
    files.push_back({(number - 1001) % 10, (number - 1001) / 10, i->path().string()});
  }
  std::sort(files.begin(), files.end(), [](const UdimFile& a, const UdimFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace etendue
