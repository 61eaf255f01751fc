#include "image_library.h"

#include <atomic>
#include <string_view>

#include "etendue/core/error.h"
#include "files/own_library.h"

namespace etendue {
namespace {

constexpr const char* file_name = "libetendue_openimageio.so";

constinit std::atomic<const ImageLibrary*> announced = nullptr;

const ImageLibrary& load() {
  if (!announced) open_own_library(file_name, "the library for image files");
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
  if (!announced && own_library_path(file_name).empty()) image_library();
}

void announce_image_library(const ImageLibrary& library, const char* version) {
  if (std::string_view(version) == ETENDUE_VERSION) announced = &library;
}

}  // namespace etendue
