#pragma once
// Meshes that KHR_draco_mesh_compression keeps, by the library Draco in a process of its own (src/draco).

#include <string>
#include <vector>

#include "draco_wire.h"

namespace etendue::gltf {

/// A mesh, and which of its attributes are wanted.
struct DracoRequest {
  std::string compressed;
  std::vector<draco_wire::AttributeAsked> attributes;
};

struct DracoMesh {
  struct Attribute {
    std::uint64_t offset = 0, width = 0, bytes = 0;  ///< where it begins; numbers for a vertex, and what these take
  };
  std::uint64_t triangles = 0, vertices = 0;
  std::uint64_t indices = 0;  ///< where they begin, three of 32 bits for each triangle
  std::vector<Attribute> attributes;
};
struct DracoMeshes {
  std::string bytes;  ///< of all of them
  std::vector<DracoMesh> meshes;
};

/// Throws Error with the reason alone; `failed` is then the mesh that cannot be read.
DracoMeshes decode_draco(const std::vector<DracoRequest>&, size_t& failed);

}  // namespace etendue::gltf
