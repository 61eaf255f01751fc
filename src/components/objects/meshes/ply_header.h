#pragma once
// What a PLY file says it holds.

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::ply {

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of a number in binary files.
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
  /// Bytes one of them takes at least.
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
  size_t size = 0;      // bytes up to the body
};

/// Throws Error with the line.
Header read_header(std::string_view file);
/// Text of the file for a message: what is not printable becomes '?'.
std::string shown(std::string_view);

}  // namespace etendue::ply
