#pragma once
// ImageTexture: interface of images as textures, with nearest, bilinear and filtered (elliptical) lookups.

#include <memory>
#include <string>

#include "footprint.h"

namespace etendue {

struct ListedImage;

/// How an image is continued outside the unit square.
enum class Wrap : std::uint8_t { repeat, mirror, clamp, black };
/// u: to the left and right of the image; v: above and below it.
struct Wraps {
  Wrap u, v;
  Wraps(Wrap both) : u(both), v(both) {}  // NOLINT: implicit, the same for both
  Wraps(Wrap along_u, Wrap along_v) : u(along_u), v(along_v) {}
};

/// An image on the unit square, (0, 0) at its lower left corner.
class ImageTexture {
 public:
  virtual ~ImageTexture();

  /// Reads the whole file, so that a damaged file is found before rendering. Images that are opened again are shared. Throws
  /// Error with the file's name and the reason.
  static std::shared_ptr<const ImageTexture> open(const std::string& path, const std::string& transfer,
                                                  const std::string& channel);
  /// A texture of an image that is no file.
  static std::shared_ptr<const ImageTexture> of(ListedImage);

  /// 3 or 1.
  virtual int channels() const = 0;

  /// Whether the image was resampled from a cube map to longitude and latitude (images/linear_image.h), so that v is clamped.
  virtual bool from_cube() const { return false; }

  /// The largest of its numbers.
  virtual float largest() const = 0;

  // Lookups write `channels` numbers. If a coordinate is NaN, all are 0.

  /// The texel that contains the point.
  virtual void nearest(Point2 at, Wraps, float* out) const = 0;
  /// Bilinear interpolation of the four nearest texels.
  virtual void bilinear(Point2 at, Wraps, float* out) const = 0;
  /// The mean over the footprint's ellipse, whose width is increased to at least its length over `maximum_anisotropy`.
  virtual void mean(Point2 at, const UvFootprint&, Wraps, float* out) const = 0;
  /// The length of the ellipse in texels.
  virtual float texels_along(const UvFootprint&) const = 0;
  static constexpr int maximum_anisotropy = 32;
};

}  // namespace etendue
