#pragma once
// Reads the triangles of a primitive of a glTF mesh.

#include "components/objects/meshes/mesh_data.h"
#include "pose.h"

namespace etendue::gltf {

/// Names the triangles of a primitive, of a mesh as stored or as deformed by a node. As a text: "meshes[3].primitives[0]" or
/// "nodes[7].primitives[0] at 0.5 of animation 1", with the suffix "with TEXCOORD_1" for the second set of texture coordinates,
/// and "… at second 2.5" for a file of another format that was converted in its state at that time.
struct PartName {
  bool of_node = false;
  size_t owner = 0, primitive = 0;
  Moment moment;
  size_t uv_set = 0;
  double converted_at = 0;  ///< [s]

  std::string text() const;
  static PartName parse(const std::string&);
};

/// In the result v points upwards, as everywhere in this program; in the file it points downwards.
MeshData read_primitive(const Document&, const PartName&);

/// Whether a primitive consists of triangles, and an upper bound of their number; throws Error if an accessor it names is
/// missing.
bool is_triangles(const Json& primitive);
size_t triangle_count(const Document&, const Json& primitive);

/// The fraction, in [0, 1], of triangle corners whose TANGENT deviates by more than 20 degrees from dp/du, or has the opposite
/// handedness for the green channel of normal maps.
double differing_tangents(const Document&, const Json& primitive, size_t uv_set);

}  // namespace etendue::gltf
