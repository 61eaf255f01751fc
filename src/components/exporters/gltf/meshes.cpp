// Writes triangles into buffers.

#include <algorithm>

#include "components/exporters/triangles/facets.h"
#include "writer.h"

namespace etendue::gltf_export {

namespace {

// Constants of glTF's accessors and buffer views (specification, sections 5.1.3 and 5.11.5).
constexpr int float_type = 5126, unsigned_int_type = 5125;
constexpr int array_buffer = 34962, element_buffer = 34963;

}  // namespace

size_t Writer::accessor(const void* data, size_t bytes, size_t count, int component_type, const char* type, int target) {
  Json& views = document_["bufferViews"];
  views.push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}, {"target", target}});
  buffer_.append(static_cast<const char*>(data), bytes);  // four-byte numbers, so that the following data stays aligned
  Json& accessors = document_["accessors"];
  accessors.push_back({{"bufferView", views.size() - 1}, {"componentType", component_type}, {"count", count}, {"type", type}});
  return accessors.size() - 1;
}

std::optional<size_t> Writer::mesh(const SceneObject& o, bool& placed) {
  if (const auto known = meshes_.find(&o); known != meshes_.end()) {
    placed = known->second.second;
    return known->second.first;
  }
  placed = false;
  bool curved = false;
  std::optional<ExportedMesh> triangles = facets_of(o, curved);
  if (curved) exporting.inexact("curved shapes become triangles", &o);
  if (!triangles) triangles = mesh_of(o, placed);
  auto& entry = meshes_[&o];
  entry = {std::nullopt, placed};
  if (!triangles || triangles->indices.empty()) return std::nullopt;

  const size_t vertices = triangles->positions.size() / 3;
  const std::vector<float> positions(triangles->positions.begin(), triangles->positions.end());
  std::array<float, 3> low{}, high{};
  for (size_t c = 0; c < 3; ++c) {
    low[c] = high[c] = positions[c];
    for (size_t i = c; i < positions.size(); i += 3) {
      low[c] = std::min(low[c], positions[i]);
      high[c] = std::max(high[c], positions[i]);
    }
  }
  const auto numbers = [&](const std::vector<float>& list, const char* type) {
    return accessor(list.data(), list.size() * sizeof(float), vertices, float_type, type, array_buffer);
  };
  Json attributes;
  attributes["POSITION"] = numbers(positions, "VEC3");
  document_["accessors"].back()["min"] = low;
  document_["accessors"].back()["max"] = high;
  if (!triangles->normals.empty()) attributes["NORMAL"] = numbers(triangles->normals, "VEC3");
  if (!triangles->uvs.empty()) {
    std::vector<float> downwards = triangles->uvs;
    for (size_t i = 1; i < downwards.size(); i += 2) downwards[i] = 1 - downwards[i];
    attributes["TEXCOORD_0"] = numbers(downwards, "VEC2");
  }
  const std::optional<size_t> surface = material(o);
  if (const auto colors = surface ? vertex_colors(o, vertices, *surface) : std::nullopt)
    attributes["COLOR_0"] = numbers(*colors, colors->size() == 4 * vertices ? "VEC4" : "VEC3");
  Json primitive{{"attributes", std::move(attributes)}};
  const auto& indices = triangles->indices;
  primitive["indices"] =
      accessor(indices.data(), indices.size() * sizeof indices[0], indices.size(), unsigned_int_type, "SCALAR", element_buffer);
  if (surface) primitive["material"] = *surface;
  Json& meshes = document_["meshes"];
  meshes.push_back({{"name", exporting.name_for(o)}, {"primitives", Json::array({std::move(primitive)})}});
  entry.first = meshes.size() - 1;
  return entry.first;
}

}  // namespace etendue::gltf_export
