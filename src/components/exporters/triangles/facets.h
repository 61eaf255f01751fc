#pragma once
// Tessellates curved and simple shapes, for programs that support only triangles.

#include <optional>

#include "components/exporters/triangles/exported_mesh.h"

namespace etendue {

/// A mesh of a shape, in object space, with its texture coordinates; sets `curved` if the mesh only approximates the shape.
/// Nothing: shapes of this class are not supported.
std::optional<ExportedMesh> facets_of(const SceneObject&, bool& curved);

}  // namespace etendue
