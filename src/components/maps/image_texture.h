#pragma once
// Images as textures: their texels, averages of those, and means over ellipses.

#include <memory>
#include <string>

#include "footprint.h"

namespace etendue {

/// What lies outside an image.
enum class Wrap : std::uint8_t { repeat, mirror, clamp, black };
/// To its left and right, and above and below it.
struct Wraps {
  Wrap u, v;
  Wraps(Wrap both) : u(both), v(both) {}  // NOLINT: one may stand for both
  Wraps(Wrap along_u, Wrap along_v) : u(along_u), v(along_v) {}
};

/// An image on the unit square, (0, 0) at its lower left corner.
class ImageTexture {
 public:
  virtual ~ImageTexture();

  /// Reads the whole file, so that a damaged one is found before rendering; the same image again is shared. Throws Error
  /// naming the file and the reason.
  static std::shared_ptr<const ImageTexture> open(const std::string& path, const std::string& transfer,
                                                  const std::string& channel);

  /// 3 or 1.
  virtual int channels() const = 0;

  /// Whether it was made of a cube of surroundings (images/linear_image.h): above its top there is the top still.
  virtual bool from_cube() const { return false; }

  /// The largest of its numbers.
  virtual float largest() const = 0;

  // Lookups write `channels` numbers. Where a coordinate is no number, all are 0.

  /// The texel.
  virtual void nearest(Point2 at, Wraps, float* out) const = 0;
  /// Between the four nearest texels.
  virtual void bilinear(Point2 at, Wraps, float* out) const = 0;
  /// The mean over the footprint's ellipse, which is widened to no less than its length over `maximum_anisotropy`.
  virtual void mean(Point2 at, const UvFootprint&, Wraps, float* out) const = 0;
  /// How many texels the ellipse is long.
  virtual float texels_along(const UvFootprint&) const = 0;
  static constexpr int maximum_anisotropy = 32;
};

}  // namespace etendue
