#pragma once
// Changes which side of a mesh is its front, for importers of programs that determine the front otherwise than by the order of
// a triangle's vertices.

#include "mesh_data.h"

namespace etendue {

/// Turns round the triangles that are clockwise as seen from the side to which their vertex normals point. Returns whether
/// there were any.
bool turn_to_normals(MeshData&);
/// Turns all triangles and normals round.
void turn_round(MeshData&);
/// Whether the mesh is closed and its triangles are clockwise as seen from outside.
bool inside_out(const MeshData&);

/// The warning of an importer that turns round a mesh that is inside out.
inline constexpr const char* medium_outside =
    "the faces of a closed mesh point inwards, so that its inner medium lies outside: the mesh is turned round";

}  // namespace etendue
