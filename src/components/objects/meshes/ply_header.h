#pragma once
// The header of a PLY file, and access to the numbers of its body.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "etendue/core/error.h"

namespace etendue::ply {

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Size of a number in binary files [bytes].
size_t size_of(Type);

struct Property {
  std::string name;
  Type type = Type::float32;
  bool list = false;
  Type count_type = Type::uint8;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  /// Least size of one element [bytes].
  size_t least_size(bool text) const {
    size_t n = 0;
    for (const Property& p : properties) n += text ? 2 : (p.list ? size_of(p.count_type) : size_of(p.type));
    return n;
  }
  bool fixed_size() const {
    for (const Property& p : properties)
      if (p.list) return false;
    return true;
  }
  int find(std::initializer_list<std::string_view> names) const {
    for (std::string_view wanted : names)
      for (size_t i = 0; i < properties.size(); ++i)
        if (properties[i].name == wanted) return int(i);
    return -1;
  }
};

struct Header {
  bool text = false, swap = false;
  std::vector<Element> elements;
  std::string texture;  // "comment TextureFile name", as MeshLab and others write
  size_t size = 0;      // size of the header [bytes]
};

/// Parses the header; throws Error with the line.
Header read_header(std::string_view file);
/// Text of the file for a message, with characters that are not printable replaced by '?'.
std::string shown(std::string_view);

template <class T>
T load(const char* at, bool swap) {
  T value;
  if (swap) {
    char bytes[sizeof(T)];
    for (size_t i = 0; i < sizeof(T); ++i) bytes[i] = at[sizeof(T) - 1 - i];
    std::memcpy(&value, bytes, sizeof(T));
  } else {
    std::memcpy(&value, at, sizeof(T));
  }
  return value;
}

inline double load_number(const char* at, Type type, bool swap) {
  switch (type) {
    case Type::int8: return load<std::int8_t>(at, swap);
    case Type::uint8: return load<std::uint8_t>(at, swap);
    case Type::int16: return load<std::int16_t>(at, swap);
    case Type::uint16: return load<std::uint16_t>(at, swap);
    case Type::int32: return load<std::int32_t>(at, swap);
    case Type::uint32: return load<std::uint32_t>(at, swap);
    case Type::float32: return double(load<float>(at, swap));
    case Type::float64: return load<double>(at, swap);
  }
  return 0;
}

/// Reads the numbers of a PLY body sequentially.
class Body {
 public:
  Body(std::string_view file, size_t start, bool text, bool swap)
      : begin_(file.data()), at_(file.data() + start), end_(file.data() + file.size()), text_(text), swap_(swap) {}

  size_t left() const { return size_t(end_ - at_); }
  const char* at() const { return at_; }
  void advance(size_t bytes) { at_ += bytes; }
  bool text() const { return text_; }
  bool swap() const { return swap_; }

  double number(Type type) {
    if (text_) return text_number();
    const size_t size = size_of(type);
    if (left() < size) truncated();
    const double value = load_number(at_, type, swap_);
    at_ += size;
    return value;
  }

  std::uint64_t count(const Property& p) {
    const double n = number(p.count_type);
    if (!(n >= 0 && n <= 4294967295.0) || n != std::floor(n)) error("a list of " + p.name + " has no valid length");
    const std::uint64_t needed = std::uint64_t(n) * (text_ ? 1 : size_of(p.type));
    if (needed > left())
      error("a list of " + p.name + " claims " + std::to_string(std::uint64_t(n)) + " entries, more than the file holds");
    return std::uint64_t(n);
  }

  void skip(const Property& p) {
    const std::uint64_t n = p.list ? count(p) : 1;
    if (text_) {
      for (std::uint64_t i = 0; i < n; ++i) text_number();
    } else {
      if (n * size_of(p.type) > left()) truncated();
      at_ += n * size_of(p.type);
    }
  }

  [[noreturn]] void truncated() const { error("the file ends too early"); }
  [[noreturn]] void error(const std::string& message) const {
    if (!text_) throw Error(message);
    throw Error("line " + std::to_string(1 + std::count(begin_, std::min(at_, end_), '\n')) + ": " + message);
  }

 private:
  double text_number() {
    while (at_ < end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
    if (at_ == end_) truncated();
    if (*at_ == '+') ++at_;
    double value = 0;
    const auto [stop, code] = std::from_chars(at_, end_, value);
    if (code == std::errc::invalid_argument) error("a number is expected");
    if (code == std::errc::result_out_of_range) value = std::numeric_limits<double>::infinity();  // its triangles are dropped
    at_ = stop;
    if (at_ < end_ && static_cast<unsigned char>(*at_) > ' ') error("a number is expected");
    return value;
  }

  const char *begin_, *at_, *end_;
  bool text_, swap_;
};

}  // namespace etendue::ply
