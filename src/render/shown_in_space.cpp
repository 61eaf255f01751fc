#include "etendue/render/shown_in_space.h"

#include <cmath>

#include "etendue/core/math.h"

namespace etendue {

Vector3 ShownLobes::direction(int row, int column) {
  const float z = 1 - 2 * (float(row) + 0.5f) / rows, r = std::sqrt(1 - z * z);
  const float phi = 2 * pi * (float(column) + 0.5f) / columns;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace etendue
