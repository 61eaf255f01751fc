#pragma once
// 3 x 3 matrices of colours, row major as in RgbSpace.

#include <array>

namespace etendue {

using ColorMatrix = std::array<double, 9>;
using ColorTriple = std::array<double, 3>;

inline ColorTriple operator*(const ColorMatrix& m, const ColorTriple& v) {
  ColorTriple r;
  for (size_t i = 0; i < 3; ++i) r[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
  return r;
}

inline ColorMatrix operator*(const ColorMatrix& a, const ColorMatrix& b) {
  ColorMatrix r{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k)
      for (size_t j = 0; j < 3; ++j) r[3 * i + k] += a[3 * i + j] * b[3 * j + k];
  return r;
}

}  // namespace etendue
