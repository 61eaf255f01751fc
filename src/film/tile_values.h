#pragma once
// How the values in ImageTile::parts_ are arranged: the triples of each pixel of the extent (PictureFormat::triples), row by
// row, and after them, if the film has bands, a SpectralBands::Light for each splat, in their order.

#include "picture_format.h"

namespace etendue {

inline size_t pixels(const PixelArea& a) { return size_t(std::max(a.width(), 0)) * size_t(std::max(a.height(), 0)); }

/// The number of values of all pixels.
inline size_t pixel_values(const PictureFormat& format, const PixelArea& extent) {
  return 3 * format.triples() * pixels(extent);
}
/// The index of a pixel's first value.
inline size_t place_of_parts(const PictureFormat& format, const PixelArea& extent, int x, int y) {
  return 3 * format.triples() * (size_t(y - extent.y0) * size_t(extent.width()) + size_t(x - extent.x0));
}
/// The number of values of a splat.
inline size_t splat_values(const PictureFormat& format) {
  static_assert(sizeof(SpectralBands::Light) == 2 * spectrum_size * sizeof(double));
  return format.bands ? 2 * spectrum_size : 0;
}

}  // namespace etendue
