#pragma once
// Serialization of numbers, lists and texts for saved states, in the memory layout of this machine: states are read only by
// machines of the same kind.

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "etendue/core/error.h"

namespace etendue {

class ByteWriter {
 public:
  std::vector<std::byte> bytes;

  template <class T>
    requires std::is_arithmetic_v<T>
  void value(T v) {
    append(&v, sizeof v);
  }
  /// Writes a list, preceded by its length.
  template <class T>
  void list(const std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(std::uint64_t(v.size()));
    append(v.data(), v.size() * sizeof(T));
  }
  void text(const std::string& s) {
    value(std::uint64_t(s.size()));
    append(s.data(), s.size());
  }

 private:
  void append(const void* data, size_t size) {
    const auto* from = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), from, from + size);
  }
};

/// Throws Error if the bytes end too early; allocates no memory for missing bytes.
class ByteReader {
 public:
  /// `what` names the bytes in errors: "the film's state".
  ByteReader(std::span<const std::byte> bytes, std::string what) : rest_(bytes), what_(std::move(what)) {}

  template <class T>
    requires std::is_arithmetic_v<T>
  T value() {
    T v;
    std::memcpy(&v, take(sizeof v), sizeof v);
    return v;
  }
  /// A list that is empty or has the expected length.
  template <class T>
  std::vector<T> list(size_t expected) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto size = value<std::uint64_t>();
    if (size != 0 && size != expected) throw Error(fmt::format("{} holds {} values where {} belong", what_, size, expected));
    if (size > rest_.size() / sizeof(T)) ends_early();
    std::vector<T> v(size);
    if (size > 0) std::memcpy(v.data(), take(size * sizeof(T)), size * sizeof(T));
    return v;
  }
  std::string text() {
    const auto size = value<std::uint64_t>();
    return {reinterpret_cast<const char*>(take(size)), size};
  }
  /// Reads the number of elements that follow, each of at least `least` bytes.
  std::uint64_t count(size_t least) {
    const auto n = value<std::uint64_t>();
    if (n > rest_.size() / least) ends_early();
    return n;
  }
  bool at_end() const { return rest_.empty(); }

 private:
  [[noreturn]] void ends_early() const { throw Error(what_ + " ends too early"); }
  const std::byte* take(std::uint64_t size) {
    if (size > rest_.size()) ends_early();
    const std::byte* at = rest_.data();
    rest_ = rest_.subspan(size);
    return at;
  }

  std::span<const std::byte> rest_;
  std::string what_;
};

}  // namespace etendue
