#pragma once
// What of a glTF file is compressed: buffer views by EXT_meshopt_compression and KHR_meshopt_compression, meshes by
// KHR_draco_mesh_compression. Document undoes both when a file is opened (compression.cpp): its buffers get what was
// compressed, and its JSON names that, so that nothing else knows of it.

#include "json_access.h"

namespace etendue::gltf {

/// Whether a buffer, by its description, holds nothing but what is also there in compressed form.
bool is_fallback(const Json& buffer);

}  // namespace etendue::gltf
