#pragma once
// Converts corners of an OBJ file's faces to vertices, and reads vertex colours.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "etendue/describe/color.h"
#include "mesh_data.h"
#include "obj_lines.h"

namespace etendue {

/// Assigns vertices to triples (position, uv, normal): the vertices of one position form a linked list, mostly of length one.
class Vertices {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;
  explicit Vertices(size_t positions) : first_(positions, none) {}

  std::uint32_t find(std::uint32_t position, std::uint32_t uv, std::uint32_t normal) {
    for (std::uint32_t i = first_[position]; i != none; i = corners_[i].next)
      if (corners_[i].uv == uv && corners_[i].normal == normal) return i;
    corners_.push_back({position, uv, normal, first_[position]});
    return first_[position] = std::uint32_t(corners_.size() - 1);
  }

  struct Corner {
    std::uint32_t position, uv, normal, next;
  };
  const std::vector<Corner>& corners() const { return corners_; }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<Corner> corners_;
};

inline std::uint32_t read_index(Lines& lines, size_t so_far, size_t all, const char* what) {
  const std::int64_t given = lines.integer();
  const std::int64_t index = given < 0 ? std::int64_t(so_far) + given : given - 1;
  if (given == 0) lines.error(std::string("the index of a ") + what + " is 0; they count from 1");
  if (index < 0 || index >= std::int64_t(all))
    lines.error(std::string("refers to ") + what + " " + std::to_string(given) + " of " +
                std::to_string(given < 0 ? so_far : all));
  return std::uint32_t(index);
}

/// The numbers of elements in an OBJ file.
struct ObjCounts {
  size_t positions = 0, uvs = 0, normals = 0, faces = 0;
  bool smoothed = false;  ///< the file has no normals, but smoothing groups
};

/// A corner of a face: "p", "p/t", "p//n" or "p/t/n".
struct ObjCorner {
  std::uint32_t position = 0, uv = Vertices::none, normal = Vertices::none;
};

/// Reads corners. Programs that omit texture coordinates or normals when they write a file often leave their indices in the
/// faces: if the file has none at all, the indices are ignored, with one warning.
class ObjCornerReader {
 public:
  ObjCornerReader(MeshData& mesh, const ObjCounts& all) : mesh_(mesh), all_(all) {}

  ObjCorner read(Lines& lines) {
    ObjCorner c;
    c.position = read_index(lines, mesh_.positions.size(), all_.positions, "vertex");
    if (lines.take('/') && !lines.word_ends()) {
      if (!lines.take('/')) {
        c.uv = index(lines, mesh_.uvs.size(), all_.uvs, "texture coordinate", no_uvs_);
        if (lines.take('/') && !lines.word_ends()) c.normal = normal(lines);
      } else if (!lines.word_ends()) {
        c.normal = normal(lines);
      }
    }
    if (!lines.word_ends()) lines.error("an index is expected");
    return c;
  }

 private:
  std::uint32_t normal(Lines& lines) { return index(lines, mesh_.normals.size(), all_.normals, "normal", no_normals_); }
  std::uint32_t index(Lines& lines, size_t so_far, size_t all, const char* what, bool& told) {
    if (all > 0) return read_index(lines, so_far, all, what);
    (void)lines.integer();
    if (!told)
      mesh_.remarks.push_back(
          fmt::format("line {}: its faces name {}s, of which the file has none: these are left out", lines.line(), what));
    told = true;
    return Vertices::none;
  }

  MeshData& mesh_;
  const ObjCounts& all_;
  bool no_uvs_ = false, no_normals_ = false;
};

// Colours of vertices, in the two forms that programs have added: red, green and blue after a vertex' position (MeshLab,
// Blender and others), and ZBrush's comments "#MRGB" with eight hexadecimal digits per vertex: mask, red, green, blue. Both are
// encoded as sRGB, as Blender reads them.
class ObjColors {
 public:
  explicit ObjColors(size_t vertices) : vertices_(vertices) {}

  /// Reads the numbers after the position of a vertex: three are its colour, one is a weight, which only curves use.
  void vertex(Lines& lines, size_t index) {
    if (lines.at_end()) return;
    float rgb[3] = {};
    try {
      for (float& x : rgb) x = lines.number();
    } catch (const Error&) {
      return;  // fewer numbers, or other text
    }
    if (!lines.at_end()) return;
    resize();
    for (size_t c = 0; c < 3; ++c) {
      values_[3 * index + c] = rgb[c];
      if (std::isfinite(rgb[c])) most_ = std::max(most_, rgb[c]);
    }
  }
  void painted(Lines& lines) {
    lines.skip_space();
    std::string_view digits = lines.left();
    resize();
    for (; digits.size() >= 8 && painted_ < vertices_; digits.remove_prefix(8), ++painted_)
      for (size_t c = 0; c < 3; ++c) {
        unsigned value = 255;
        std::from_chars(digits.data() + 2 + 2 * c, digits.data() + 4 + 2 * c, value, 16);
        values_[3 * painted_ + c] = float(value) / 255;
      }
  }
  /// Adds the colours to a mesh whose vertices are those of the file.
  void give(MeshData& mesh) {
    if (values_.empty()) return;
    const float scale = most_ > 1 ? 1.0f / 255 : 1;  // some programs write values from 0 to 255
    for (float& x : values_) x *= scale;
    replace_infinite_colors(values_, mesh);
    for (float& x : values_) x = float(decode_transfer("srgb", double(std::clamp(x, 0.0f, 1.0f))));
    mesh.attributes.push_back({"color", 3, std::move(values_)});
  }

 private:
  /// Vertices without colour are white.
  void resize() {
    if (values_.empty()) values_.resize(3 * vertices_, 1.0f);
  }

  size_t vertices_, painted_ = 0;
  std::vector<float> values_;
  float most_ = 0;
};

}  // namespace etendue
