#pragma once
// Meshes that are bent: by morph targets and by skins.

#include "components/objects/meshes/mesh_data.h"
#include "pose.h"

namespace etendue::gltf {

/// Adds the morph targets of a primitive and bends it by the node's skin. With a skin places are the scene's afterwards, else
/// still the node's. `uv_set`: which of the file's surface coordinates the mesh has.
void bend(const Document&, const Json& primitive, size_t node, const Pose&, size_t uv_set, MeshData&);

}  // namespace etendue::gltf
