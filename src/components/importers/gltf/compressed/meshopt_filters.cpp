#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <type_traits>

#include "etendue/core/error.h"
#include "meshopt.h"

namespace etendue::gltf {
namespace {

/// The nearest integer, clamped to the range of T; NaN, from damaged files, becomes 0.
template <class T>
T rounded(float x) {
  if (!(x == x)) return 0;
  return T(std::round(std::clamp(x, float(std::numeric_limits<T>::min()), float(std::numeric_limits<T>::max()))));
}

/// Calls `undo` for each element of four numbers of type T.
template <class T, class Undo>
void each_four(std::uint64_t count, char* bytes, Undo undo) {
  for (std::uint64_t i = 0; i < count; ++i) {
    std::array<T, 4> four;
    std::memcpy(four.data(), bytes + i * sizeof four, sizeof four);
    undo(four);
    std::memcpy(bytes + i * sizeof four, four.data(), sizeof four);
  }
}

/// Unit vectors, stored as x and y on an octahedron unfolded to a square; the third number represents 1.
template <class T>
void undo_octahedral(std::uint64_t count, char* bytes) {
  each_four<T>(count, bytes, [](std::array<T, 4>& v) {
    const auto one = float(v[2]);
    float x = float(v[0]) / one, y = float(v[1]) / one;
    const float z = 1 - std::abs(x) - std::abs(y), beyond = std::min(z, 0.0f);
    x -= std::copysign(beyond, x);
    y -= std::copysign(beyond, y);
    const float scale = float(std::numeric_limits<T>::max()) / std::sqrt(x * x + y * y + z * z);
    v = {rounded<T>(x * scale), rounded<T>(y * scale), rounded<T>(z * scale), v[3]};
  });
}

/// Unit quaternions without their largest component, which is positive. The last number represents 1, except for its two lowest
/// bits, which are the index of the largest component.
void undo_quaternion(std::uint64_t count, char* bytes) {
  each_four<std::int16_t>(count, bytes, [](std::array<std::int16_t, 4>& q) {
    const float scale = float(1 / std::numbers::sqrt2) / float(q[3] | 3);
    const float x = float(q[0]) * scale, y = float(q[1]) * scale, z = float(q[2]) * scale;
    const auto largest = size_t(q[3] & 3);
    const float all[4] = {std::sqrt(std::max(0.0f, 1 - x * x - y * y - z * z)), x, y, z};
    for (size_t i = 0; i < 4; ++i) q[(largest + i) % 4] = rounded<std::int16_t>(all[i] * 32767);
  });
}

/// Numbers stored as a 24-bit mantissa times two to the power of an 8-bit exponent.
void undo_exponential(std::uint64_t count, char* bytes) {
  for (std::uint64_t i = 0; i < count; ++i) {
    std::int32_t packed = 0;
    std::memcpy(&packed, bytes + 4 * i, 4);
    const std::int32_t mantissa = std::int32_t(std::uint32_t(packed) << 8) >> 8;
    const float value = std::ldexp(float(mantissa), packed >> 24);
    std::memcpy(bytes + 4 * i, &value, 4);
  }
}

/// Luma, two signed chroma values, and alpha with one bit less; the highest set bit of the last number determines the number of
/// bits.
template <class T>
void undo_color(std::uint64_t count, char* bytes) {
  each_four<T>(count, bytes, [](std::array<T, 4>& v) {
    using Signed = std::make_signed_t<T>;
    const int most = (1 << std::bit_width(unsigned(v[3]))) - 1;
    const int luma = v[0], orange = Signed(v[1]), green = Signed(v[2]);
    const int half = v[3] & (most >> 1), alpha = 2 * half | (half & 1);
    const float scale = most > 0 ? float(std::numeric_limits<T>::max()) / float(most) : 0;
    const int all[4] = {luma + orange - green, luma + green, luma - orange - green, alpha};
    for (size_t i = 0; i < 4; ++i) v[i] = rounded<T>(float(all[i]) * scale);
  });
}

}  // namespace

void undo_meshopt_filter(MeshoptFilter filter, std::uint64_t count, std::uint64_t stride, char* bytes) {
  const auto refuse = [&](const char* name, const char* wanted) {
    throw Error(std::string("the filter ") + name + " needs a 'byteStride' of " + wanted + ", not " + std::to_string(stride));
  };
  const bool small = stride == 4, fits = small || stride == 8;
  switch (filter) {
    case MeshoptFilter::none: break;
    case MeshoptFilter::octahedral:
      if (!fits) refuse("OCTAHEDRAL", "4 or 8");
      small ? undo_octahedral<std::int8_t>(count, bytes) : undo_octahedral<std::int16_t>(count, bytes);
      break;
    case MeshoptFilter::quaternion:
      if (stride != 8) refuse("QUATERNION", "8");
      undo_quaternion(count, bytes);
      break;
    case MeshoptFilter::exponential: undo_exponential(count * (stride / 4), bytes); break;
    case MeshoptFilter::color:
      if (!fits) refuse("COLOR", "4 or 8");
      small ? undo_color<std::uint8_t>(count, bytes) : undo_color<std::uint16_t>(count, bytes);
      break;
  }
}

}  // namespace etendue::gltf
