#pragma once
// Objects as triangle meshes, for export to other programs.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "etendue/scene_object.h"

namespace etendue {

/// Vertices in object space, three numbers each, or two for texture coordinates. Normals and texture coordinates are per
/// vertex, or absent. The front is the side from which corners run counter-clockwise.
struct ExportedMesh {
  std::vector<double> positions;
  std::vector<float> normals, uvs;
  std::vector<std::uint32_t> indices;
};

/// The triangles of a TriangleMesh as written or as in its file; those of any other object made of triangles with the object's
/// transform applied (`placed`), in the space of its parent. Nothing: it has none.
std::optional<ExportedMesh> mesh_of(const SceneObject&, bool& placed);

/// A binary PLY file.
std::string ply_of(const ExportedMesh&);

}  // namespace etendue
