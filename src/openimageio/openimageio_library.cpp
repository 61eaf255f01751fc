// Registers OpenImageIO as the program's image library.

#include "cached_texture.h"
#include "checked_open.h"
#include "file_input.h"
#include "file_output.h"
#include "images/image_library.h"
#include "images/linear_image.h"
#include "images/listed_image.h"
#include "linear_input.h"

namespace etendue {
namespace {

class OpenImageIoLibrary final : public ImageLibrary {
 public:
  OpenImageIoLibrary() { announce_image_library(*this, ETENDUE_VERSION); }
  StoredImage read(const std::string& path) const override { return read_file(path); }
  LinearImage read_linear(const std::string& path, const std::string& transfer, const std::string& channel) const override {
    return read_linear_file(path, transfer, channel);
  }
  std::vector<std::string> channel_names(const std::string& path) const override {
    return open_checked(path)->spec().channelnames;
  }
  void check_channel(const std::string& path, const std::string& channel) const override { check_file_channel(path, channel); }
  std::shared_ptr<const ImageTexture> open_texture(const std::string& path, const std::string& transfer,
                                                   const std::string& channel) const override {
    return CachedTexture::open(path, transfer, channel);
  }
  std::shared_ptr<const ImageTexture> texture_of(ListedImage image) const override { return CachedTexture::of(image); }
  std::vector<unsigned char> encode(const std::string& extension, const ImageHeader& header,
                                    const PixelValues& pixels) const override {
    return encode_file(extension, header, pixels);
  }
};

const OpenImageIoLibrary library;

}  // namespace
}  // namespace etendue
