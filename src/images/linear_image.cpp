// Reads image files as linear values, and opens textures.

#include "linear_image.h"

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "files/file_kind.h"
#include "files/regular_file.h"
#include "image_library.h"
#include "listed_image.h"

namespace etendue {
namespace {

/// Returns the result of `use` with the image library; errors are rethrown with the file's name.
template <class Use>
auto reading(const std::string& path, Use use) {
  try {
    return use(image_library());
  } catch (const Error& e) {
    const std::string mistaken = mistaken_contents(path);
    throw Error("cannot read '" + path + "': " + (mistaken.empty() ? std::string(e.what()) : mistaken));
  } catch (const std::bad_alloc&) {
    throw Error("cannot read '" + path + "': " + no_memory_to_read);
  }
}

}  // namespace

std::vector<std::string> image_transfer_names() {
  std::vector<std::string> names = transfer_names();
  names.insert(names.begin(), automatic_transfer);
  return names;
}

void check_channel(const std::string& path, const std::string& channel) {
  if (channel.empty()) return;
  try {
    image_library().check_channel(path, channel);
  } catch (const std::bad_alloc&) {
    throw Error("cannot read '" + path + "': " + no_memory_to_read);
  }
}

std::vector<std::string> image_channels(const std::string& path) {
  return reading(path, [&](const ImageLibrary& library) { return library.channel_names(path); });
}

LinearImage read_linear_image(const std::string& path, const std::string& transfer, const std::string& channel) {
  return reading(path, [&](const ImageLibrary& library) { return library.read_linear(path, transfer, channel); });
}

std::shared_ptr<const ImageTexture> read_texture(const std::string& path, const std::string& transfer,
                                                 const std::string& channel) {
  return reading(path, [&](const ImageLibrary& library) { return library.open_texture(path, transfer, channel); });
}

std::shared_ptr<const ImageTexture> texture_of(ListedImage image) { return image_library().texture_of(std::move(image)); }

}  // namespace etendue
