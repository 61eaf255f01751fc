#pragma once
// Linear sRGB of colours in XYZ, as the page shows them.

#include <array>

#include "etendue/describe/color.h"

namespace etendue::studio {

class LinearSrgb {
 public:
  std::array<double, 3> operator()(double x, double y, double z) const {
    std::array<double, 3> rgb{};
    for (size_t i = 0; i < 3; ++i) rgb[i] = from_xyz_[3 * i] * x + from_xyz_[3 * i + 1] * y + from_xyz_[3 * i + 2] * z;
    return rgb;
  }

 private:
  const std::array<double, 9>& from_xyz_ = rgb_space("srgb").from_xyz;
};

}  // namespace etendue::studio
