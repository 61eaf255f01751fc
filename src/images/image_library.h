#pragma once
// What reads and writes image files. It is OpenImageIO, in a library of its own (src/openimageio) that is loaded when it is
// first needed: OpenImageIO brings some 250 shared libraries, and loading these takes longer than all else at the start.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "etendue/core/image.h"
#include "etendue/film/image_buffer.h"

namespace etendue {

class ImageTexture;
struct LinearImage;

/// How a file keeps the numbers of a channel.
enum class NumberType : std::uint8_t { uint8, uint16, half, single };

/// What an image file is to hold beside its numbers. What a format does not know is left out.
struct ImageHeader {
  struct Channel {
    std::string name;
    NumberType type;
  };
  /// An image with the usual channels for their number (Y, YA, RGB or RGBA), all of one type.
  ImageHeader(int width, int height, int channels, NumberType);
  ImageHeader(int width, int height, std::vector<Channel>);

  int width, height;
  std::vector<Channel> channels;
  int x = 0, y = 0;      ///< where the pixels begin
  PixelArea whole;       ///< the display window, of which the pixels are a part or which is a part of them; empty: the pixels
  std::string transfer;  ///< how colours are encoded, "linear" or "srgb"; empty: the file does not say
  std::optional<std::array<float, 8>> chromaticities;  ///< CIE x and y of red, green, blue and white
  std::map<std::string, std::string> texts;
  std::optional<int> compression_level;  ///< of PNG, 0 to 9
  int tile_side = 0;                     ///< of square tiles; 0: the pixels lie in lines
};

/// Pixels from top to bottom, channels interleaved. Whole numbers stand for fractions of the largest of their type.
using PixelValues = std::variant<std::span<const std::uint8_t>, std::span<const std::uint16_t>, std::span<const float>>;

/// An image as its file holds it: not decoded, with the file's own texts and the place of a crop as metadata.
struct StoredImage {
  Image image;
  std::string transfer;  ///< "linear" or "srgb", by what the format says, else by the type of its numbers
};

/// Errors tell the reason; whoever asks names the file.
class ImageLibrary {
 public:
  virtual ~ImageLibrary();
  virtual StoredImage read(const std::string& path) const = 0;
  virtual LinearImage read_linear(const std::string& path, const std::string& transfer, const std::string& channel) const = 0;
  /// See images/linear_image.h.
  virtual std::vector<std::string> channel_names(const std::string& path) const = 0;
  virtual void check_channel(const std::string& path, const std::string& channel) const = 0;
  /// See ImageTexture::open.
  virtual std::shared_ptr<const ImageTexture> open_texture(const std::string& path, const std::string& transfer,
                                                           const std::string& channel) const = 0;
  /// The bytes of a file in the format of an ending (".png").
  virtual std::vector<unsigned char> encode(const std::string& extension, const ImageHeader&, const PixelValues&) const = 0;
};

/// Loads the library at the first call; from any thread. Throws Error when it cannot be loaded.
const ImageLibrary& image_library();
/// Throws Error when there is no library to be loaded, without loading one that is where it should be: what is only needed
/// after a long render should be missed before.
void require_image_library();

/// Called when the library is loaded, with the version it was built for.
void announce_image_library(const ImageLibrary&, const char* version);

}  // namespace etendue
