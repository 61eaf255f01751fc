#pragma once
// The interface to image files. They are read and written by OpenImageIO, in a separate library (src/openimageio) that is
// loaded on first use: OpenImageIO depends on some 250 shared libraries, and loading them takes longer than everything else at
// the program's start.

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
struct ListedImage;

/// The type in which a file stores the numbers of a channel.
enum class NumberType : std::uint8_t { uint8, uint16, half, single };

/// The header data of an image file. Data that the format does not support are left out.
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
  int x = 0, y = 0;      ///< position of the first pixel
  PixelArea whole;       ///< the display window, which may be larger or smaller than the pixels' window; empty: the same
  std::string transfer;  ///< the encoding of colours, "linear" or "srgb"; empty: not stated
  std::optional<std::array<float, 8>> chromaticities;  ///< CIE x and y of red, green, blue and white
  std::map<std::string, std::string> texts;
  std::optional<int> compression_level;  ///< of PNG, 0 to 9
  int tile_side = 0;                     ///< of square tiles; 0: scan lines
};

/// Pixels from top to bottom, channels interleaved. Integers represent fractions of the largest value of their type.
using PixelValues = std::variant<std::span<const std::uint8_t>, std::span<const std::uint16_t>, std::span<const float>>;

/// An image as stored in its file: not decoded, with the file's texts and the position of a crop as metadata.
struct StoredImage {
  Image image;
  std::string transfer;  ///< "linear" or "srgb", as stated in the file, else by the type of its numbers
};

/// Errors contain the reason; the caller adds the file's name.
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
  /// See ImageTexture::of.
  virtual std::shared_ptr<const ImageTexture> texture_of(ListedImage) const = 0;
  /// The bytes of a file in the format of an extension (".png").
  virtual std::vector<unsigned char> encode(const std::string& extension, const ImageHeader&, const PixelValues&) const = 0;
};

/// Loads the library at the first call; thread-safe. Throws Error if it cannot be loaded.
const ImageLibrary& image_library();
/// Throws Error if there is no library to be loaded, without loading an existing one: so that a library needed only after a
/// long render is found missing before it.
void require_image_library();

/// Called by the library when it is loaded, with the version it was built for.
void announce_image_library(const ImageLibrary&, const char* version);

}  // namespace etendue
