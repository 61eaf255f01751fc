#include "etendue/render/shown_in_space.h"

#include <cmath>

#include "etendue/core/math.h"

namespace etendue {

Vector3 ShownLobes::direction(int row, int column, float down, float along) {
  const float z = 1 - 2 * (float(row) + down) / rows, r = std::sqrt(1 - z * z);
  const float phi = 2 * pi * (float(column) + along) / columns;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace etendue
