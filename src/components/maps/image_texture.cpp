#include "image_texture.h"

#include "images/linear_image.h"
#include "images/listed_image.h"

namespace etendue {

ImageTexture::~ImageTexture() = default;

std::shared_ptr<const ImageTexture> ImageTexture::open(const std::string& path, const std::string& transfer,
                                                       const std::string& channel) {
  return read_texture(path, transfer, channel);
}

std::shared_ptr<const ImageTexture> ImageTexture::of(ListedImage image) { return texture_of(std::move(image)); }

}  // namespace etendue
