#pragma once
// Half precision floats (IEEE 754 binary16), as displays take them.

#include <bit>
#include <cstdint>

namespace etendue::studio {

/// Rounds to the nearest half, ties to even; values too large become the largest half, NaN becomes 0.
inline std::uint16_t to_half(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const auto sign = std::uint16_t(bits >> 16 & 0x8000);
  const std::uint32_t size = bits & 0x7FFFFFFF;
  constexpr std::uint32_t infinite = 0x7F800000;
  if (size > infinite) return 0;
  constexpr std::uint32_t too_large = 0x477FF000;  // 65520: values from here on round to infinity
  if (size >= too_large) return sign | 0x7BFF;
  constexpr std::uint32_t least_normal = 0x38800000;  // 2^-14
  if (size < least_normal) {
    // Adding 2^-1 leaves the multiple of 2^-24 in the low bits, rounded by the processor.
    const float shifted = std::bit_cast<float>(size) + 0.5f;
    return sign | std::uint16_t(std::bit_cast<std::uint32_t>(shifted) - std::bit_cast<std::uint32_t>(0.5f));
  }
  const std::uint32_t rounded = size + 0x0FFF + (size >> 13 & 1);
  return sign | std::uint16_t((rounded - (std::uint32_t(127 - 15) << 23)) >> 13);
}

}  // namespace etendue::studio
