// STL files, text and binary: lists of separate triangles. Corners at the same position are merged to one vertex, so that
// surfaces are closed.
//
// Two conventions store colours of triangles, 15 bits of sRGB, in the last two bytes of a record of a binary file (Wikipedia,
// "STL (file format)", section "Color in binary STL"). VisCAM and SolidView: the highest bit marks a colour; blue is in the
// lowest bits, then green, then red. Materialise Magics: the header contains "COLOR=" and four bytes, the colour of the whole
// object; a triangle whose highest bit is not set has its own colour, with red in the lowest bits. The two bytes were intended
// as the length of attributes, 0, and other programs store arbitrary values there: ColorBits decides whether they can be
// colours.

#include <bit>
#include <cstring>
#include <unordered_map>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "geometry/usable_triangles.h"
#include "mesh_data.h"
#include "obj_lines.h"

namespace etendue {
namespace {

/// Merges vertices by the bits of their positions.
class Corners {
 public:
  explicit Corners(MeshData& mesh) : mesh_(mesh) {}

  std::uint32_t add(Point3 p) {
    for (int k = 0; k < 3; ++k) p[k] += 0.0f;  // turns -0 into 0
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

std::string small(std::string_view text) {
  std::string all(text);
  for (char& c : all) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return all;
}

/// Statistics of the last two bytes of all triangles.
class ColorBits {
 public:
  explicit ColorBits(std::string_view file) : file_(file), count_(binary_count(file)) {
    for (size_t i = 0; i < count_; ++i) {
      const std::uint16_t bits = (*this)[i];
      same_ = same_ && bits == (*this)[0];
      numbers_ = numbers_ && bits == std::uint16_t(i + (*this)[0]) && (*this)[0] <= 1;
      zero_ += bits == 0;
      marked_ += bits >> 15 != 0;
      black_ += bits == mark;
      unmarked_ += bits >> 15 == 0 && bits != 0;
    }
    numbers_ = numbers_ && count_ > 2;
  }

  std::uint16_t operator[](size_t i) const {
    std::uint16_t bits = 0;
    std::memcpy(&bits, file_.data() + head + 4 + i * record + 12 * sizeof(float), sizeof bits);
    return bits;
  }

  /// The reason why the bytes are not VisCAM colours although some have the highest bit set; "" if they can be colours.
  const char* why_not_viscam() const {
    if (said_in_head("viscam") || said_in_head("solidview")) return "";
    if (marked_ == black_) return "all that they could say is black";
    if (same_ && (*this)[0] == 0xffff) return "all their bits are set, everywhere";
    if (numbers_) return "they count the triangles";
    // Triangles that are not marked have no colour, and mostly the value 0; of arbitrary values, about half are marked.
    constexpr size_t few = 16;
    if (count_ >= few && 2 * unmarked_ > marked_)
      return "too many triangles have bits without the one that says that they are a colour";
    return "";
  }
  bool any_marked() const { return marked_ > 0; }
  /// With a Magics header: all bytes are 0, as programs without colours of triangles write them.
  bool all_zero() const { return zero_ == count_; }
  bool counts_triangles() const { return numbers_; }

 private:
  bool said_in_head(const char* name) const { return small(file_.substr(0, head)).find(name) != std::string::npos; }

  static constexpr std::uint16_t mark = 0x8000;
  std::string_view file_;
  size_t count_, zero_ = 0, marked_ = 0, black_ = 0, unmarked_ = 0;
  bool same_ = true, numbers_ = true;
};

void give_colors(std::string_view file, MeshData& mesh) {
  constexpr std::string_view magics_mark = "COLOR=";
  const std::string_view header = file.substr(0, head);
  const ColorBits bits(file);
  const size_t place = header.find(magics_mark);
  const bool magics = place != std::string_view::npos && place + magics_mark.size() + 4 <= header.size();
  if (!magics && !bits.any_marked()) return;
  const std::string rubbish = magics ? (bits.counts_triangles() ? "they count the triangles" : "") : bits.why_not_viscam();
  if (!rubbish.empty()) mesh.remarks.push_back("the two bytes behind each triangle are not taken for its colour: " + rubbish);
  if (!magics && !rubbish.empty()) return;
  const auto linear = [](double fraction) { return float(decode_transfer("srgb", fraction)); };
  std::array<float, 3> all{0.7f, 0.7f, 0.7f};  // for triangles without their own colour
  for (size_t k = 0; magics && k < 3; ++k)
    all[k] = linear(double(static_cast<unsigned char>(header[place + magics_mark.size() + k])) / 255);
  const bool own_colors = rubbish.empty() && !(magics && bits.all_zero());
  std::vector<float> values;
  values.reserve(3 * mesh.triangles.size());
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const bool own = own_colors && (bits[i] >> 15 != 0) != magics;
    for (int k = 0; k < 3; ++k)
      values.push_back(own ? linear(double(bits[i] >> 5 * (magics ? k : 2 - k) & 31) / 31) : all[size_t(k)]);
  }
  mesh.face_attributes.push_back({"face_color", 3, std::move(values)});
}

MeshData read_binary(std::string_view file) {
  if (file.size() < head + 4) throw Error("the file ends within its head");
  const size_t count = binary_count(file);
  if ((file.size() - head - 4) / record < count)
    throw Error("it says that it has " + std::to_string(count) + " triangles, but ends after " +
                std::to_string((file.size() - head - 4) / record));
  MeshData mesh;
  mesh.triangles.reserve(count);
  Corners corners(mesh);
  for (size_t i = 0; i < count; ++i) {
    float numbers[12];
    std::memcpy(numbers, file.data() + head + 4 + i * record, sizeof numbers);
    std::array<std::uint32_t, 3> t{};
    for (size_t k = 0; k < 3; ++k) t[k] = corners.add({numbers[3 + 3 * k], numbers[4 + 3 * k], numbers[5 + 3 * k]});
    mesh.triangles.push_back(t);
  }
  give_colors(file, mesh);
  return mesh;
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
  // Some binary files also begin with "solid"; they are recognized by their length.
  const std::string begin = small(file.substr(0, 1024));
  const bool solid = begin.starts_with("solid");
  const bool text = solid && file.size() != head + 4 + record * binary_count(file) && begin.find("facet") != std::string::npos;
  MeshData mesh = text || (solid && file.size() < head + 4) ? read_text(file) : read_binary(file);
  if (mesh.triangles.empty()) throw NoTriangles("it has no triangles");
  return mesh;
}

}  // namespace etendue
