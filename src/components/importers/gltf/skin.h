#pragma once
// Deformation of meshes by morph targets and skins.

#include "components/objects/meshes/mesh_data.h"
#include "pose.h"

namespace etendue::gltf {

/// Applies the morph targets of a primitive and the node's skin. With a skin the resulting positions are in scene space, else
/// in the node's space. `uv_set`: the set of texture coordinates in `mesh`.
void bend(const Document&, const Json& primitive, size_t node, const Pose&, size_t uv_set, MeshData&);

}  // namespace etendue::gltf
