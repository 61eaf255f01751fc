#pragma once
// The corners of an OBJ file's faces as vertices, and the colours of vertices.

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <vector>

#include "etendue/describe/color.h"
#include "mesh_data.h"
#include "obj_lines.h"

namespace etendue {

/// Vertices by (position, uv, normal): those of one position form a chain, mostly of length one.
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

// Colours of vertices, in the two forms that programs have added: red, green and blue behind a vertex's place (MeshLab, Blender
// and others), and ZBrush's comments "#MRGB" with eight hexadecimal digits for a vertex: a mask, red, green, blue. Both are
// encoded as sRGB, as Blender reads them.
class ObjColors {
 public:
  explicit ObjColors(size_t vertices) : vertices_(vertices) {}

  /// What stands behind the place of a vertex: three numbers are its colour, one is a weight that only curves have.
  void vertex(Lines& lines, size_t index) {
    if (lines.at_end()) return;
    float rgb[3] = {};
    try {
      for (float& x : rgb) x = lines.number();
    } catch (const Error&) {
      return;  // fewer numbers, or something else
    }
    if (!lines.at_end()) return;
    resize();
    for (size_t c = 0; c < 3; ++c) {
      values_[3 * index + c] = rgb[c];
      most_ = std::max(most_, rgb[c]);
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
  /// To a mesh whose vertices are those of the file.
  void give(MeshData& mesh) {
    if (values_.empty()) return;
    const float scale = most_ > 1 ? 1.0f / 255 : 1;  // bytes, as some write
    for (float& x : values_) x = float(decode_transfer("srgb", double(std::clamp(x * scale, 0.0f, 1.0f))));
    mesh.attributes.push_back({"color", 3, std::move(values_)});
  }

 private:
  /// White where nothing is said.
  void resize() {
    if (values_.empty()) values_.resize(3 * vertices_, 1.0f);
  }

  size_t vertices_, painted_ = 0;
  std::vector<float> values_;
  float most_ = 0;
};

}  // namespace etendue
