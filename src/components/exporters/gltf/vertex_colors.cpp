// Writes vertex colours and alpha as COLOR_0.

#include <algorithm>

#include "components/objects/meshes/mesh_data.h"
#include "writer.h"

namespace etendue::gltf_export {

// A mesh without vertex colours gets the colour that its shader uses in that case. For materials that do not read vertex
// colours none are written, as COLOR_0 multiplies the base colour of any material.
std::optional<std::vector<float>> Writer::vertex_colors(const SceneObject& o, size_t vertices, size_t material) {
  const auto found = from_vertices_.find(material);
  if (found == from_vertices_.end()) return std::nullopt;
  const FromVertices& taken = found->second;
  std::vector<float> colors, alphas;
  if (class_of(o) == "TriangleMesh") {
    if (const std::string file = word_of(o, "file"); !file.empty()) {
      for (const VertexAttribute& a : read_mesh(file, word_of(o, "part")).attributes) {
        if (a.name == "color" && a.width == 3) colors = a.values;
        if (a.name == "alpha" && a.width == 1) alphas = a.values;
      }
    } else {
      for (const double x : numbers_of(o, "colors")) colors.push_back(float(x));
    }
  }
  std::vector<float> all;
  const bool colored = taken.color && colors.size() == 3 * vertices, faded = taken.alpha && alphas.size() == vertices;
  if (!colored && !faded && (!taken.color || *taken.color == std::array<double, 3>{1, 1, 1})) return std::nullopt;
  for (size_t i = 0; i < vertices; ++i) {
    for (size_t c = 0; c < 3; ++c) all.push_back(colored ? colors[3 * i + c] : (taken.color ? float((*taken.color)[c]) : 1));
    if (faded) all.push_back(alphas[i]);
  }
  return all;
}

}  // namespace etendue::gltf_export
