#pragma once
// Decodes meshes of KHR_draco_mesh_compression with the library Draco in a process of its own (src/draco).

#include <string>
#include <vector>

#include "draco_wire.h"

namespace etendue::gltf {

/// A compressed mesh, and the attributes to decode.
struct DracoRequest {
  std::string compressed;
  std::vector<draco_wire::AttributeAsked> attributes;
};

struct DracoMesh {
  struct Attribute {
    std::uint64_t offset = 0, width = 0, bytes = 0;  ///< offset in DracoMeshes::bytes; components per vertex, and their size
  };
  std::uint64_t triangles = 0, vertices = 0;
  std::uint64_t indices = 0;  ///< offset; three 32-bit indices for each triangle
  std::vector<Attribute> attributes;
};
struct DracoMeshes {
  std::string bytes;  ///< the decoded data of all meshes
  std::vector<DracoMesh> meshes;
};

/// Throws Error with the reason, without a location; `failed` is then the index of the mesh that cannot be decoded.
DracoMeshes decode_draco(const std::vector<DracoRequest>&, size_t& failed);

}  // namespace etendue::gltf
