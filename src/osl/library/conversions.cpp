// Conversions of attributes' values to what a shader asks for.

#include "conversions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace etendue::osl {

namespace {

/// Where the target's floats come from: indices of the source's floats, -1 for zero. Empty if there is no conversion.
struct Pattern {
  int count = 0;
  std::array<int, 3> from{};
};

Pattern pattern(const Type& from, const Type& to) {
  const int floats = from.base == Base::int_ && !from.is_array() ? 1 : from.floats() * from.elements();
  const bool one = floats == 1 && !from.is_array();
  const bool numbers = from.base == Base::float_ && from.array > 0;
  if (to.is_float() && one) return {1, {0}};
  if (to.is_triple() && one) return {3, {0, 0, 0}};
  if (to == Type(Base::float_, 2) && one) return {2, {0, 0}};
  if (to.is_triple() && from.is_triple()) return {3, {0, 1, 2}};
  if (to.is_triple() && numbers && floats == 2) return {3, {0, 1, -1}};
  if (to.is_triple() && numbers && (floats == 3 || floats == 4)) return {3, {0, 1, 2}};
  if (to == Type(Base::float_, 3) && from.is_triple()) return {3, {0, 1, 2}};
  return {};
}

bool same_memory(const Type& from, const Type& to) {
  if (from == to) return true;
  return from.triple_based() && to.triple_based() && from.array == to.array;
}

int truncated(float x) { return x >= 2147483648.0f ? 2147483647 : (x > -2147483904.0f ? int(x) : -2147483647 - 1); }

}  // namespace

bool convert_value(const Type& from, bool from_derivatives, const void* value, const Type& to, bool to_derivatives, void* out) {
  const std::size_t size = to.size();
  auto* target = static_cast<std::byte*>(out);
  if (same_memory(from, to)) {
    std::memcpy(target, value, size);
    if (!to_derivatives) return true;
    if (from_derivatives)
      std::memcpy(target + size, static_cast<const std::byte*>(value) + size, 2 * size);
    else
      std::memset(target + size, 0, 2 * size);
    return true;
  }
  if (to.is_int() && from.is_float()) {
    const int whole = truncated(*static_cast<const float*>(value));
    std::memcpy(target, &whole, sizeof whole);
    return true;
  }
  const Pattern p = pattern(from, to);
  if (p.count == 0) return false;
  float whole = 0;
  const float* numbers = static_cast<const float*>(value);
  if (from.base == Base::int_) whole = float(*static_cast<const int*>(value)), numbers = &whole, from_derivatives = false;
  const int stride = from.base == Base::int_ ? 1 : from.floats() * from.elements();
  for (int block = 0; block < (to_derivatives ? 3 : 1); ++block)
    for (int k = 0; k < p.count; ++k) {
      const int i = p.from[std::size_t(k)];
      const float x = i < 0 || (block && !from_derivatives) ? 0 : numbers[block * stride + i];
      std::memcpy(target + sizeof(float) * std::size_t(block * p.count + k), &x, sizeof x);
    }
  return true;
}

}  // namespace etendue::osl
