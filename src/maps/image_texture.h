#pragma once
// Images as textures: their texels, averages of those, and means over ellipses.

#include <OpenImageIO/imagecache.h>

#include <memory>
#include <string>
#include <vector>

#include "maps/footprint.h"

namespace etendue {

/// What lies outside an image.
enum class Wrap : std::uint8_t { repeat, mirror, clamp, black };

/// An image on the unit square, (0, 0) at its lower left corner. Its texels stay in OpenImageIO's cache, which reads them from
/// the file again when memory is short; levels of averages, each half as wide and half as high as the one before, are kept.
class ImageTexture {
 public:
  /// Reads the whole file, so that a damaged one is found before rendering; the same image again is shared. Throws Error
  /// naming the file and the reason.
  static std::shared_ptr<const ImageTexture> open(const std::string& path, const std::string& transfer,
                                                  const std::string& channel);

  /// 3 or 1.
  int channels() const { return channels_; }

  // Lookups write `channels` numbers. Where a coordinate is no number, all are 0.

  /// The texel.
  void nearest(Point2 at, Wrap, float* out) const;
  /// Between the four nearest texels.
  void bilinear(Point2 at, Wrap, float* out) const;
  /// The mean over a circle of texels as wide as the footprint is long.
  void trilinear(Point2 at, const UvFootprint&, Wrap, float* out) const;
  /// The mean over the footprint's ellipse, which is widened to no less than its length over `maximum_anisotropy`.
  void anisotropic(Point2 at, const UvFootprint&, Wrap, float* out) const;
  static constexpr int maximum_anisotropy = 32;

  static constexpr int tile_side = 64;  ///< of the cache's tiles

 private:
  friend class TexelReader;
  struct Level {
    int width = 0, height = 0;
    std::vector<float> texels;  // from the top row to the lowest; none at level 0
  };

  void read(const std::string& path);
  /// The mean along a line of `length` texels, from -half_line to half_line, of what level `detail` shows.
  void line(Point2 at, Vector2 half_line, float length, float detail, Wrap, float* out) const;

  OIIO::ImageCache::ImageHandle* handle_ = nullptr;
  int channels_ = 3;
  int left_ = 0, top_ = 0;           // of the display window, in the file's pixels
  int begin_x_ = 0, begin_y_ = 0;    // of the pixels that are there, in the display window
  int pixels_x_ = 0, pixels_y_ = 0;  // how many are there
  std::vector<Level> levels_;
};

}  // namespace etendue
