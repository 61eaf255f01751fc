#pragma once
// The protocol between this program and etendue_draco (src/draco). Numbers are in native byte order: both run on one machine.
//
// Request, for each mesh: MeshAsked, that many AttributeAsked, the compressed bytes. Answer, for each mesh: MeshMade, one
// AttributeMade for each attribute, three 32-bit vertex indices for each triangle, then the values of each attribute for all
// vertices.

#include <cstdint>

namespace etendue::draco_wire {

struct MeshAsked {
  std::uint64_t bytes, attributes;
};
struct AttributeAsked {
  std::uint32_t id;         ///< attribute id in the compressed data
  std::uint32_t component;  ///< component type, by glTF's code
};
struct MeshMade {
  std::uint64_t triangles, vertices;
};
struct AttributeMade {
  std::uint64_t width, bytes;  ///< components per vertex, and their size
};

}  // namespace etendue::draco_wire
