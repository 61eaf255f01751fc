#pragma once
// Objects made of triangles, as other programs take them.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "etendue/scene_object.h"

namespace etendue {

/// Vertices in the object's own coordinates, three numbers each, or two for surface coordinates. Normals and surface
/// coordinates are by vertex, or absent. The front is where corners run counter-clockwise.
struct ExportedMesh {
  std::vector<double> positions;
  std::vector<float> normals, uvs;
  std::vector<std::uint32_t> indices;
};

/// The triangles of a TriangleMesh as it was written or as its file says; those of any other object that is made of triangles
/// in the coordinates of what contains it (`placed`), its transform done. Nothing: it has none.
std::optional<ExportedMesh> mesh_of(const SceneObject&, bool& placed);

/// A binary PLY file.
std::string ply_of(const ExportedMesh&);

}  // namespace etendue
