#pragma once
// A picture as it is sent to browsers: in tiles, each of which knows when it changed last. docs/studio-protocol.md describes
// the bytes.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "etendue/core/image.h"

namespace etendue::studio {

/// Where a picture stands in the whole one, and what it is of.
struct FrameInfo {
  std::uint32_t generation = 0;
  std::uint32_t x0 = 0, y0 = 0, full_width = 0, full_height = 0;
  std::uint32_t samples = 0;
  bool coarse = false, finished = false;
};

/// Never changes once it is made.
class Frame {
 public:
  static constexpr int tile = 64;
  enum class Kind : std::uint8_t { linear = 1, toned = 2 };

  /// Three channels of a picture, from `first` on: X Y Z, which become linear sRGB, when `xyz`; else they are what is shown.
  /// Tiles that are the same as in the frame before keep their age. `number` is larger than that of the frame before.
  static std::shared_ptr<const Frame> make(Kind, const Image&, size_t first, bool xyz, const FrameInfo&, std::uint64_t number,
                                           const Frame* before);

  std::uint64_t number() const { return number_; }
  /// Whether tiles sent of the other frame may stay on a screen when this one follows.
  bool continues(const Frame& other) const;
  /// A message with the tiles that changed after a frame of this number; all when it is 0. `slot`: which of the pictures that
  /// a page watches it is.
  std::vector<std::uint8_t> message(std::uint64_t after, int slot) const;
  const FrameInfo& info() const { return info_; }
  int width() const { return width_; }
  int height() const { return height_; }
  /// The bytes of a pixel: three halves or three bytes.
  const std::uint8_t* pixel(int x, int y) const;
  float scale() const { return scale_; }

 private:
  struct Tile {
    int x = 0, y = 0, width = 0, height = 0;
    size_t begin = 0, size = 0;  // bytes
    std::uint64_t changed = 0;
  };
  size_t pixel_size() const { return kind_ == Kind::linear ? 6 : 3; }
  void lay_out();

  Kind kind_ = Kind::linear;
  int width_ = 0, height_ = 0;
  float scale_ = 1;
  FrameInfo info_;
  std::uint64_t number_ = 0;
  std::vector<Tile> tiles_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace etendue::studio
