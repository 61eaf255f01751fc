#pragma once
// The triangles of a primitive of a glTF mesh.

#include "components/objects/meshes/mesh_data.h"
#include "pose.h"

namespace etendue::gltf {

/// Which triangles of a file: those of a primitive of a mesh as it is, or as a node bends it. As a text:
/// "meshes[3].primitives[0]" or "nodes[7].primitives[0] at 0.5 of animation 1", and "with TEXCOORD_1" when the second set of
/// surface coordinates is meant; "… at second 2.5" of a file of another format that was converted as it is then.
struct PartName {
  bool of_node = false;
  size_t owner = 0, primitive = 0;
  Moment moment;
  size_t uv_set = 0;
  double converted_at = 0;  ///< [s]

  std::string text() const;
  static PartName parse(const std::string&);
};

/// v runs upwards in what this gives, as everywhere in this program; in the file it runs downwards.
MeshData read_primitive(const Document&, const PartName&);

/// Whether a primitive is of triangles, and how many it has at most; throws Error when what it names is not there.
bool is_triangles(const Json& primitive);
size_t triangle_count(const Document&, const Json& primitive);

/// How much, in [0, 1], of the corners of a primitive's triangles have a TANGENT that turns by more than 20 degrees from where
/// its surface coordinates grow, or tells the other side for green to tilt to.
double differing_tangents(const Document&, const Json& primitive, size_t uv_set);

}  // namespace etendue::gltf
