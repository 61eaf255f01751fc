#pragma once
// Conversion of values to bytes and back, for saved states.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "etendue/core/error.h"

namespace etendue {

template <class T>
void append(std::vector<std::byte>& to, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto bytes = std::as_bytes(std::span(&value, 1));
  to.insert(to.end(), bytes.begin(), bytes.end());
}

/// Reads a value from the front of the bytes, and removes it there.
template <class T>
T take(std::span<const std::byte>& from) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value;
  if (from.size() < sizeof value) throw Error("a guide's bytes end too early");
  std::memcpy(static_cast<void*>(&value), from.data(), sizeof value);
  from = from.subspan(sizeof value);
  return value;
}

/// A list, preceded by its length.
template <class T>
void append_all(std::vector<std::byte>& to, const std::vector<T>& values) {
  append(to, std::uint64_t(values.size()));
  const auto bytes = std::as_bytes(std::span(values));
  to.insert(to.end(), bytes.begin(), bytes.end());
}

template <class T>
std::vector<T> take_all(std::span<const std::byte>& from) {
  const auto size = take<std::uint64_t>(from);
  if (size > from.size() / sizeof(T)) throw Error("a guide's bytes end too early");
  std::vector<T> values(static_cast<size_t>(size));
  std::memcpy(static_cast<void*>(values.data()), from.data(), values.size() * sizeof(T));
  from = from.subspan(values.size() * sizeof(T));
  return values;
}

}  // namespace etendue
