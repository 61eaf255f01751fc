#pragma once
// Colours of the vertices of OBJ files, in the two forms that programs have added: red, green and blue behind a vertex's place
// (MeshLab, Blender and others), and ZBrush's comments "#MRGB" with eight hexadecimal digits for a vertex: a mask, red, green,
// blue. Both are encoded as sRGB, as Blender reads them.

#include <charconv>

#include "etendue/describe/color.h"
#include "mesh_data.h"
#include "obj_lines.h"

namespace etendue {

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
