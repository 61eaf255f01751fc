#pragma once
// Frame: a picture as it is sent to browsers, in tiles that each store when they last changed. docs/studio-protocol.md
// describes the bytes.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "etendue/core/image.h"

namespace etendue::studio {

/// The position of a picture within the whole one, and the state of its render.
struct FrameInfo {
  std::uint32_t generation = 0;
  std::uint32_t x0 = 0, y0 = 0, full_width = 0, full_height = 0;
  std::uint32_t samples = 0;
  bool coarse = false, finished = false;
};

/// Immutable after construction.
class Frame {
 public:
  static constexpr int tile = 64;
  enum class Kind : std::uint8_t { linear = 1, toned = 2 };

  /// Makes a frame of three channels from `first` on: if `xyz`, they are X Y Z and converted to linear sRGB; otherwise they are
  /// display values. Tiles equal to those of the previous frame keep its age. `number` must be larger than that of the previous
  /// frame.
  static std::shared_ptr<const Frame> make(Kind, const Image&, size_t first, bool xyz, const FrameInfo&, std::uint64_t number,
                                           const Frame* before);

  std::uint64_t number() const { return number_; }
  /// Whether tiles of the other frame may stay on the screen when this frame follows.
  bool continues(const Frame& other) const;
  /// A message with the tiles that changed after the frame with this number; with all tiles for 0. `slot`: index of the picture
  /// among those that the page watches.
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
