#pragma once
// CachedTexture: textures whose texels are stored in memory or in OpenImageIO's cache.

#include <OpenImageIO/imagecache.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "components/maps/image_texture.h"
#include "images/listed_image.h"
#include "kept_texels.h"

namespace etendue {

/// Texels are stored in memory as long as all stored textures fit into half of the machine's memory. Further textures use
/// OpenImageIO's cache, which reads tiles from the file again when memory is short. (A lookup in stored texels takes a fifth of
/// the time of one in the cache, whose tiles are found by hashing and reference-counted.) The MIP levels, each half as wide and
/// high as the one before, are built when a mean is first computed, and stored.
class CachedTexture final : public ImageTexture {
 public:
  /// See ImageTexture::open; errors state the reason without the path.
  static std::shared_ptr<const CachedTexture> open(const std::string& path, const std::string& transfer,
                                                   const std::string& channel);
  /// See ImageTexture::of. The texels are stored in memory whatever it takes, as there is no file to read them from again.
  static std::shared_ptr<const CachedTexture> of(const ListedImage&);

  int channels() const override { return channels_; }
  bool from_cube() const override { return from_cube_; }
  float largest() const override { return largest_; }
  void nearest(Point2 at, Wraps, float* out) const override;
  void bilinear(Point2 at, Wraps, float* out) const override;
  void mean(Point2 at, const UvFootprint&, Wraps, float* out) const override;
  float texels_along(const UvFootprint&) const override;

  static constexpr int tile_side = 64;  ///< side of the cache's tiles [texels]

 private:
  friend class TexelReader;
  struct Level {
    int width = 0, height = 0;
    std::vector<float> texels;  // top row first; empty at level 0
  };

  void read(const std::string& key);
  void read_header(const OIIO::ImageSpec&);
  bool keep(const std::string& key);
  /// Calls use(first row, end row, values) for some rows of stored pixels at a time. Returns false if the file is damaged.
  template <class Use>
  bool read_rows(Use use) const;
  void make_levels() const;
  bool add_kept_between(float x, float y, Wraps, float* out) const;
  /// The mean over a line of `length` texels, from -half_line to half_line, filtered at the level `detail`.
  void line(Point2 at, Vector2 half_line, float length, float detail, Wraps, float* out) const;

  std::unique_ptr<KeptTexels> kept_;  // null: in the cache
  bool kept_whole_ = false;           // in memory, and the pixels fill the display window
  OIIO::ImageCache::ImageHandle* handle_ = nullptr;
  int channels_ = 3;
  bool from_cube_ = false;
  float largest_ = 0;
  int left_ = 0, top_ = 0;           // origin of the display window, in the file's pixels
  int begin_x_ = 0, begin_y_ = 0;    // origin of the stored pixels, in the display window
  int pixels_x_ = 0, pixels_y_ = 0;  // number of stored pixels
  OIIO::ustring name_;               // the file's key in the cache
  mutable std::once_flag levels_made_;
  mutable std::vector<Level> levels_;  // level 0 is the image; the others are built on demand
};

}  // namespace etendue
