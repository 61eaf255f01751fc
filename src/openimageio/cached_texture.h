#pragma once
// Textures whose texels stay in memory, or in OpenImageIO's cache.

#include <OpenImageIO/imagecache.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "components/maps/image_texture.h"
#include "kept_texels.h"

namespace etendue {

/// Its texels are kept as long as all kept ones fit into half of the machine's memory. Those of further images stay in
/// OpenImageIO's cache, which reads them from the file again when memory is short. (A lookup in kept ones takes a fifth of the
/// time of one in the cache, whose tiles are found by hashing and counted.) Levels of averages, each half as wide and half as
/// high as the one before, are made when the first mean is asked for, and kept.
class CachedTexture final : public ImageTexture {
 public:
  /// See ImageTexture::open; errors tell the reason alone.
  static std::shared_ptr<const CachedTexture> open(const std::string& path, const std::string& transfer,
                                                   const std::string& channel);

  int channels() const override { return channels_; }
  bool from_cube() const override { return from_cube_; }
  float largest() const override { return largest_; }
  void nearest(Point2 at, Wraps, float* out) const override;
  void bilinear(Point2 at, Wraps, float* out) const override;
  void mean(Point2 at, const UvFootprint&, Wraps, float* out) const override;
  float texels_along(const UvFootprint&) const override;

  static constexpr int tile_side = 64;  ///< of the cache's tiles

 private:
  friend class TexelReader;
  struct Level {
    int width = 0, height = 0;
    std::vector<float> texels;  // from the top row to the lowest; none at level 0
  };

  void read(const std::string& key);
  void read_header(const OIIO::ImageSpec&);
  bool keep(const std::string& key);
  /// Passes over the pixels that are there, some rows at a time: use(first row, end, their numbers). False: the file is bad.
  template <class Use>
  bool read_rows(Use use) const;
  void make_levels() const;
  bool add_kept_between(float x, float y, Wraps, float* out) const;
  /// The mean along a line of `length` texels, from -half_line to half_line, of what level `detail` shows.
  void line(Point2 at, Vector2 half_line, float length, float detail, Wraps, float* out) const;

  std::unique_ptr<KeptTexels> kept_;  // null: in the cache
  bool kept_whole_ = false;           // kept, and there is a pixel for each place of the display window
  OIIO::ImageCache::ImageHandle* handle_ = nullptr;
  int channels_ = 3;
  bool from_cube_ = false;
  float largest_ = 0;
  int left_ = 0, top_ = 0;           // of the display window, in the file's pixels
  int begin_x_ = 0, begin_y_ = 0;    // of the pixels that are there, in the display window
  int pixels_x_ = 0, pixels_y_ = 0;  // how many are there
  OIIO::ustring name_;               // of the file, in the cache
  mutable std::once_flag levels_made_;
  mutable std::vector<Level> levels_;  // the image itself; the others when they are asked for
};

}  // namespace etendue
