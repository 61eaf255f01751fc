#pragma once
// Packing: the results of a Schedule as bytes, in which they travel between processes. The bytes have the memory layout of this
// kind of machine.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "etendue/core/error.h"

namespace etendue {

/// A type with a packing of its own: `value.pack(bytes)` appends bytes, and `T::unpack(bytes)` removes them from the front and
/// returns an equal value.
template <class T>
concept PacksItself = requires(const T& value, std::vector<std::byte>& to, std::span<const std::byte>& from) {
  value.pack(to);
  { T::unpack(from) } -> std::same_as<T>;
};

/// Whether values can be packed. A trivially copyable type must not contain pointers, which mean nothing in another process.
template <class T>
inline constexpr bool packable = PacksItself<T> || (std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
template <class T>
inline constexpr bool packable<std::vector<T>> = packable<T>;

/// Packs values of all packable types, and vectors of them.
struct Packing {
  template <class T>
  static void pack(std::vector<std::byte>& to, const T& value) {
    if constexpr (PacksItself<T>)
      value.pack(to);
    else
      append(to, &value, sizeof value);
  }
  template <class T>
  static void pack(std::vector<std::byte>& to, const std::vector<T>& values) {
    pack(to, std::uint64_t(values.size()));
    if constexpr (!PacksItself<T> && std::is_trivially_copyable_v<T>)
      append(to, values.data(), values.size() * sizeof(T));
    else
      for (const T& value : values) pack(to, value);
  }

  /// Replaces `value` by the one at the front of the bytes, which is removed there. Throws Error if the bytes end too early.
  template <class T>
  static void unpack(std::span<const std::byte>& from, T& value) {
    if constexpr (PacksItself<T>)
      value = T::unpack(from);
    else
      take(from, &value, sizeof value);
  }
  template <class T>
  static void unpack(std::span<const std::byte>& from, std::vector<T>& values) {
    std::uint64_t size = 0;
    unpack(from, size);
    if constexpr (!PacksItself<T> && std::is_trivially_copyable_v<T>) {
      if (size > from.size() / sizeof(T)) ends_early();
      values.resize(size_t(size));
      take(from, values.data(), values.size() * sizeof(T));
    } else {
      if (size > from.size()) ends_early();  // each takes a byte at least
      values.resize(size_t(size));
      for (T& value : values) unpack(from, value);
    }
  }

 private:
  static void append(std::vector<std::byte>& to, const void* data, size_t size) {
    const auto* bytes = static_cast<const std::byte*>(data);
    to.insert(to.end(), bytes, bytes + size);
  }
  static void take(std::span<const std::byte>& from, void* data, size_t size) {
    if (size > from.size()) ends_early();
    if (size > 0) std::memcpy(data, from.data(), size);
    from = from.subspan(size);
  }
  [[noreturn]] static void ends_early() { throw Error("packed values end too early"); }
};

}  // namespace etendue
