#pragma once
// Cache of meshes read from files, shared between objects.

#include "triangle_object.h"

namespace etendue {

/// The mesh of a file or of a part of it, ready for TriangleObject::adopt. It is read once as long as it is in use and the file
/// is unchanged. With `whole` it includes unusable triangles, which may have an area at another key. Throws Error with file and
/// reason.
std::shared_ptr<const MeshData> mesh_from_file(const std::string& path, const std::string& part, bool whole);

}  // namespace etendue
