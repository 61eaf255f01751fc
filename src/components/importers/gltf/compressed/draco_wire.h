#pragma once
// How this program asks etendue_draco (src/draco), and what it answers. Numbers as they lie in memory: both run on one machine.
//
// Asked, for each mesh: MeshAsked, so many AttributeAsked, its compressed bytes. Answered, for each: MeshMade, so many
// AttributeMade, three vertices of 32 bits for each triangle, then each attribute for all vertices.

#include <cstdint>

namespace etendue::draco_wire {

struct MeshAsked {
  std::uint64_t bytes, attributes;
};
struct AttributeAsked {
  std::uint32_t id;         ///< within the compressed data
  std::uint32_t component;  ///< type of its numbers, by glTF's code
};
struct MeshMade {
  std::uint64_t triangles, vertices;
};
struct AttributeMade {
  std::uint64_t width, bytes;  ///< numbers for a vertex, and what these take
};

}  // namespace etendue::draco_wire
