#pragma once
// VertexAttributes: values per vertex, such as colours, interpolated at points of triangles.

#include <span>

#include "etendue/mesh_facts.h"
#include "mesh_data.h"

namespace etendue {

class VertexAttributes {
 public:
  void take(std::vector<VertexAttribute> from) {
    list_.clear();
    for (VertexAttribute& a : from) list_.push_back({attribute_number(a.name), a.width, std::move(a.values)});
  }
  bool empty() const { return list_.empty(); }

  /// See SceneObject::attribute.
  int at(int number, const std::array<std::uint32_t, 3>& corners, float u, float v, float* values) const {
    for (const Numbered& a : list_) {
      if (a.number != number) continue;
      const size_t width = size_t(a.width);
      const float *v0 = &a.values[corners[0] * width], *v1 = &a.values[corners[1] * width], *v2 = &a.values[corners[2] * width];
      for (size_t i = 0; i < width; ++i) values[i] = (1 - u - v) * v0[i] + u * v1[i] + v * v2[i];
      return a.width;
    }
    return 0;
  }

 private:
  struct Numbered {
    int number, width;
    std::vector<float> values;
  };
  std::vector<Numbered> list_;
};

}  // namespace etendue
