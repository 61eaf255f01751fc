#pragma once
// Compression in glTF files: of buffer views by EXT_meshopt_compression and KHR_meshopt_compression, of meshes by
// KHR_draco_mesh_compression. Document decompresses both when a file is opened (compression.cpp), adds the result to its
// buffers and changes its JSON to refer to it, so that no other code has to handle compression.

#include "json_access.h"

namespace etendue::gltf {

/// Whether a buffer is a fallback: a copy of data that is also stored in compressed form.
bool is_fallback(const Json& buffer);

}  // namespace etendue::gltf
