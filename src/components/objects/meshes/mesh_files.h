#pragma once
// Meshes of files that several objects share.

#include "triangle_object.h"

namespace etendue {

/// What a file, or a part of it, holds, ready to be adopted: read once for as long as somebody has it and the file is the same.
/// `whole`: with the triangles that cannot be used, for at another key they may have an area. Throws Error with file and
/// reason.
std::shared_ptr<const MeshData> mesh_from_file(const std::string& path, const std::string& part, bool whole);

}  // namespace etendue
