#pragma once
// ImageBuffer: the description of the image to be rendered: size, filter, crop window, layers (the parameters of pbrt's and
// Mitsuba's Film). The samples are accumulated by Film (film.h).

#include <memory>
#include <string>
#include <vector>

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/filter.h"

namespace etendue {

/// Pixel rectangle [x0, x1) x [y0, y1).
struct PixelArea {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  bool operator==(const PixelArea&) const = default;
};

/// Data derived from the description, for films and tiles.
struct PictureFormat;

class ImageBuffer : public Component {
 public:
  using Interface = ImageBuffer;
  using Parent = Component;
  static void describe(Description<ImageBuffer>&);
  ImageBuffer();
  ~ImageBuffer() override;

  int width = 512, height = 512;
  Ref<Filter> filter;
  std::vector<int> crop;            ///< x0, y0, x1, y1 [pixels]; empty: all
  std::vector<std::string> layers;  ///< further channels: "depth", "variance", "light.lamp", …
  int path_lengths = 0;             ///< number of layers by path length; the last one includes all longer paths

  void prepare() override;

  /// The pixels of the result: the crop window, or all.
  const PixelArea& area() const;
  /// The pixels that are sampled: `area`, and around a crop window a border as wide as the filter, so that the pixels of the
  /// crop are the same as in the whole image.
  const PixelArea& sampled_area() const;
  bool wants(const std::string& layer) const;

  /// Immutable: `prepare` makes a new one. It stays valid if the description is edited or destroyed.
  const std::shared_ptr<const PictureFormat>& format() const { return format_; }

 private:
  std::shared_ptr<const PictureFormat> format_;
};

}  // namespace etendue
