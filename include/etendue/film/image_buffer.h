#pragma once
// ImageBuffer: the description of a picture to be taken. What collects its samples is a Film (film.h).

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

/// What follows from the description, as films and tiles use it.
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
  std::vector<std::string> layers;  ///< of "albedo", "normal", "depth", "object", "variance", "samples"
  int path_lengths = 0;             ///< how many layers to keep by path length; the last holds all longer paths too

  void prepare() override;

  /// The pixels to be rendered.
  const PixelArea& area() const;
  /// The pixels to take samples of: those, and around a crop as many as the filter reaches, so that its pixels are the same as
  /// in the whole picture.
  const PixelArea& sampled_area() const;
  bool wants_features() const;
  bool wants(const std::string& layer) const;

  /// Never changes: preparing again makes another. Who holds it need not care whether the description lives or is edited.
  const std::shared_ptr<const PictureFormat>& format() const { return format_; }

 private:
  std::shared_ptr<const PictureFormat> format_;
};

}  // namespace etendue
