#pragma once
// Rectangles of pixels.

#include <algorithm>

#include "etendue/film/image_buffer.h"

namespace etendue {

inline PixelArea intersection(const PixelArea& a, const PixelArea& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// The rectangle enlarged by so many pixels on each side.
inline PixelArea widened(const PixelArea& a, int by) { return {a.x0 - by, a.y0 - by, a.x1 + by, a.y1 + by}; }

}  // namespace etendue
