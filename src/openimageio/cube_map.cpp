#include "cube_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace etendue {
namespace {

/// A face and a position in it, from its upper left corner: 0 to 1 to the right and down.
struct Place {
  int face;
  double right, down;
};

/// Source: ImfEnvmap.h, whose diagram of the cube labels the corners of each face.
Place place_in_cube(double x, double y, double z) {
  const double ax = std::abs(x), ay = std::abs(y), az = std::abs(z);
  const auto part = [](double a, double of) { return (a / of + 1) / 2; };
  if (ax >= ay && ax >= az) return {x > 0 ? 0 : 1, part(x > 0 ? z : -z, ax), part(-y, ax)};
  if (ay >= az) return {y > 0 ? 2 : 3, part(x, ay), part(y > 0 ? -z : z, ay)};
  return {z > 0 ? 4 : 5, part(z > 0 ? -x : x, az), part(-y, az)};
}

}  // namespace

void CubeMap::add(double x, double y, double z, double weight, double* sum) const {
  const Place at = place_in_cube(x, y, z);
  const double column = at.right * (side_ - 1), row = at.down * (side_ - 1);
  const int left = std::clamp(int(column), 0, std::max(side_ - 2, 0)), top = std::clamp(int(row), 0, std::max(side_ - 2, 0));
  const double along = column - left, across = row - top;
  const int right = std::min(left + 1, side_ - 1), bottom = std::min(top + 1, side_ - 1);
  const auto pixel = [&](int i, int j) {
    return pixels_.data() + (size_t(at.face * side_ + j) * size_t(side_) + size_t(i)) * size_t(channels_);
  };
  const float *a = pixel(left, top), *b = pixel(right, top), *c = pixel(left, bottom), *d = pixel(right, bottom);
  for (int k = 0; k < channels_; ++k)
    sum[k] += weight * ((1 - across) * ((1 - along) * double(a[k]) + along * double(b[k])) +
                        across * ((1 - along) * double(c[k]) + along * double(d[k])));
}

void CubeMap::row(int y, float* out) const {
  constexpr int parts = 3;  // samples per texel, along each side
  for (int x = 0; x < width(); ++x) {
    std::array<double, 4> sum{};
    double weights = 0;
    for (int j = 0; j < parts; ++j) {
      const double theta = std::numbers::pi * (y + (j + 0.5) / parts) / height(), sine = std::sin(theta);
      for (int i = 0; i < parts; ++i) {
        const double phi = 2 * std::numbers::pi * (x + (i + 0.5) / parts) / width();
        add(sine * std::sin(phi), std::cos(theta), -sine * std::cos(phi), sine, sum.data());
        weights += sine;
      }
    }
    for (int k = 0; k < channels_; ++k) *out++ = float(sum[size_t(k)] / weights);
  }
}

}  // namespace etendue
