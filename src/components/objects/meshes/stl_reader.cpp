// STL files, text and binary: triangles one by one. Corners in the same place become one vertex, so that surfaces close.
//
// Two habits put colours of triangles, 15 bits of sRGB, into the two bytes that close a record of a binary file (Wikipedia,
// "STL (file format)", section "Color in binary STL"). VisCAM's and SolidView's: the highest bit says that there is a colour,
// red is above green and blue is lowest. Materialise Magics': the head holds "COLOR=" and four bytes, the colour of all; where
// the highest bit is not set a triangle has its own, with red lowest.

#include <bit>
#include <cstring>
#include <unordered_map>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "mesh_data.h"
#include "obj_lines.h"

namespace etendue {
namespace {

/// Vertices by the bits of their places.
class Corners {
 public:
  explicit Corners(MeshData& mesh) : mesh_(mesh) {}

  std::uint32_t add(Point3 p) {
    for (int k = 0; k < 3; ++k) p[k] += 0.0f;  // -0 is 0
    const auto [place, fresh] = places_.try_emplace(p, std::uint32_t(mesh_.positions.size()));
    if (fresh) mesh_.positions.push_back(p);
    return place->second;
  }

 private:
  struct Hash {
    size_t operator()(const Point3& p) const {
      std::uint64_t h = 0;
      for (int k = 0; k < 3; ++k) h = (h ^ std::bit_cast<std::uint32_t>(p[k])) * 0x9e3779b97f4a7c15u;
      return size_t(h ^ h >> 32);
    }
  };
  struct Same {
    bool operator()(const Point3& a, const Point3& b) const { return std::memcmp(&a, &b, sizeof a) == 0; }
  };
  MeshData& mesh_;
  std::unordered_map<Point3, std::uint32_t, Hash, Same> places_;
};

constexpr size_t head = 80, record = 50;

size_t binary_count(std::string_view file) {
  std::uint32_t count = 0;
  if (file.size() >= head + 4) std::memcpy(&count, file.data() + head, 4);
  return count;
}

class Colors {
 public:
  Colors(std::string_view header, size_t triangles) {
    constexpr std::string_view mark = "COLOR=";
    const size_t place = header.find(mark);
    magics_ = place != std::string_view::npos && place + mark.size() + 4 <= header.size();
    for (size_t k = 0; k < 3; ++k) all_[k] = 0.7f;
    if (magics_)
      for (size_t k = 0; k < 3; ++k)
        all_[k] = linear(double(static_cast<unsigned char>(header[place + mark.size() + k])) / 255);
    any_ = magics_;
    values_.reserve(3 * triangles);
  }

  void add(std::uint16_t bits) {
    const bool own = (bits >> 15 != 0) != magics_;
    any_ = any_ || own;
    for (int k = 0; k < 3; ++k) {
      const int five = bits >> 5 * (magics_ ? k : 2 - k) & 31;
      values_.push_back(own ? linear(double(five) / 31) : all_[size_t(k)]);
    }
  }

  void give(MeshData& mesh) {
    if (any_) mesh.face_attributes.push_back({"face_color", 3, std::move(values_)});
  }

 private:
  static float linear(double fraction) { return float(decode_transfer("srgb", fraction)); }
  bool magics_ = false, any_ = false;
  std::array<float, 3> all_{};  // of what has none of its own
  std::vector<float> values_;
};

MeshData read_binary(std::string_view file) {
  if (file.size() < head + 4) throw Error("the file ends within its head");
  const size_t count = binary_count(file);
  if ((file.size() - head - 4) / record < count)
    throw Error("it says that it has " + std::to_string(count) + " triangles, but ends after " +
                std::to_string((file.size() - head - 4) / record));
  MeshData mesh;
  mesh.triangles.reserve(count);
  Corners corners(mesh);
  Colors colors(file.substr(0, head), count);
  for (size_t i = 0; i < count; ++i) {
    float numbers[12];
    std::uint16_t bits = 0;
    std::memcpy(&bits, file.data() + head + 4 + i * record + sizeof numbers, sizeof bits);
    colors.add(bits);
    std::memcpy(numbers, file.data() + head + 4 + i * record, sizeof numbers);
    std::array<std::uint32_t, 3> t{};
    for (size_t k = 0; k < 3; ++k) t[k] = corners.add({numbers[3 + 3 * k], numbers[4 + 3 * k], numbers[5 + 3 * k]});
    mesh.triangles.push_back(t);
  }
  colors.give(mesh);
  return mesh;
}

std::string small(std::string_view text) {
  std::string all(text);
  for (char& c : all) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return all;
}

MeshData read_text(std::string_view file) {
  MeshData mesh;
  Corners corners(mesh);
  std::vector<std::uint32_t> facet;
  for (Lines lines(file); lines.next();) {
    const std::string word = small(lines.keyword());
    if (word == "vertex") {
      const float x = lines.number(), y = lines.number(), z = lines.number();
      facet.push_back(corners.add({x, y, z}));
      if (facet.size() > 3) lines.error("a facet has three corners");
    } else if (word == "endloop") {
      if (facet.size() != 3) lines.error("a facet has three corners");
      mesh.triangles.push_back({facet[0], facet[1], facet[2]});
      facet.clear();
    }
  }
  if (!facet.empty()) throw Error("the file ends within a facet");
  return mesh;
}

}  // namespace

MeshData read_stl(std::string_view file) {
  // Some binary files begin with "solid" too; their length tells.
  const std::string begin = small(file.substr(0, 1024));
  const bool solid = begin.starts_with("solid");
  const bool text = solid && file.size() != head + 4 + record * binary_count(file) && begin.find("facet") != std::string::npos;
  MeshData mesh = text || (solid && file.size() < head + 4) ? read_text(file) : read_binary(file);
  if (mesh.triangles.empty()) throw Error("it has no triangles");
  return mesh;
}

}  // namespace etendue
