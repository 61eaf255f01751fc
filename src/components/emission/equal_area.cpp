// Resampling of equal-area square images of directions to images in longitude and latitude.

#include "equal_area.h"

#include <fmt/format.h>

#include <cmath>

#include "etendue/core/error.h"
#include "geometry/equal_area_square.h"

namespace etendue {
namespace {

constexpr double exact_pi = 3.14159265358979323846;

/// Adds `weight` times the bilinear value of the image at a place of the square to `sum`.
void add(const LinearImage& image, SquarePlace at, double weight, double* sum) {
  const int n = image.width;
  const double px = at.x * n - 0.5, py = at.y * n - 0.5;
  const int x0 = int(std::floor(px)), y0 = int(std::floor(py));
  for (int dy = 0; dy < 2; ++dy)
    for (int dx = 0; dx < 2; ++dx) {
      int x = x0 + dx, y = y0 + dy;
      const double part = (dx ? px - x0 : 1 - (px - x0)) * (dy ? py - y0 : 1 - (py - y0)) * weight;
      fold_equal_area(x, y, n);
      for (size_t c = 0; c < 3; ++c) sum[c] += part * double(image.rgb[(size_t(y) * size_t(n) + size_t(x)) * 3 + c]);
    }
}

}  // namespace

LinearImage unfold_equal_area(const LinearImage& square) {
  if (square.width != square.height || square.width < 1)
    throw Error(fmt::format("an image of directions in equal areas is a square, not {} x {}", square.width, square.height));
  LinearImage result;
  result.width = 2 * square.width;
  result.height = square.width;
  const size_t width = size_t(result.width), height = size_t(result.height);
  result.rgb.resize(3 * width * height);
  constexpr int parts = 2;  // across and down each texel
  for (size_t j = 0; j < height; ++j)
    for (size_t i = 0; i < width; ++i) {
      double sum[3]{};
      for (int k = 0; k < parts * parts; ++k) {
        const double phi = 2 * exact_pi * (double(i) + (k % parts + 0.5) / parts) / double(width);
        const double theta = exact_pi * (double(j) + (k / parts + 0.5) / parts) / double(height);
        // The environment's (x, y, z) = (sin theta sin phi, cos theta, -sin theta cos phi); the square's third axis is y.
        add(square, equal_area_place({std::sin(theta) * std::sin(phi), std::sin(theta) * std::cos(phi), std::cos(theta)}),
            1.0 / (parts * parts), sum);
      }
      for (size_t c = 0; c < 3; ++c) result.rgb[3 * (j * width + i) + c] = float(sum[c]);
    }
  return result;
}

}  // namespace etendue
