#include "image_library.h"

#include <dlfcn.h>

#include <atomic>
#include <filesystem>
#include <string_view>

#include "etendue/core/error.h"

namespace etendue {
namespace {

constexpr const char* file_name = "libetendue_openimageio.so";

constinit std::atomic<const ImageLibrary*> announced = nullptr;

/// The library's path, in the folder of the library that contains this code; empty: no such file.
std::string path_beside() {
  Dl_info own{};
  if (!dladdr(reinterpret_cast<void*>(&image_library), &own) || !own.dli_fname) return {};
  const std::filesystem::path path = std::filesystem::path(own.dli_fname).parent_path() / file_name;
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) ? path.string() : std::string();
}

const ImageLibrary& load() {
  if (!announced) {
    const std::string path = path_beside();
    // Never closed, as textures and their code may be in use until the program ends. Lazy binding, as binding all functions of
    // so many libraries at once would take a sixth longer.
    if (!dlopen(path.empty() ? file_name : path.c_str(), RTLD_LAZY | RTLD_LOCAL))
      throw Error(fmt::format("the library for image files cannot be loaded: {}", dlerror()));
  }
  if (!announced) throw Error(fmt::format("'{}' is not of this version of Étendue", file_name));
  return *announced;
}

std::vector<ImageHeader::Channel> usual_channels(int count, NumberType type) {
  const std::vector<const char*> names = count < 3 ? std::vector{"Y", "A"} : std::vector{"R", "G", "B", "A"};
  std::vector<ImageHeader::Channel> channels;
  for (size_t i = 0; i < size_t(count); ++i) channels.push_back({names.at(i), type});
  return channels;
}

}  // namespace

ImageHeader::ImageHeader(int w, int h, int count, NumberType type) : ImageHeader(w, h, usual_channels(count, type)) {}
ImageHeader::ImageHeader(int w, int h, std::vector<Channel> list) : width(w), height(h), channels(std::move(list)) {}

ImageLibrary::~ImageLibrary() = default;

const ImageLibrary& image_library() {
  static const ImageLibrary& library = load();
  return library;
}

void require_image_library() {
  if (!announced && path_beside().empty()) image_library();
}

void announce_image_library(const ImageLibrary& library, const char* version) {
  if (std::string_view(version) == ETENDUE_VERSION) announced = &library;
}

}  // namespace etendue
