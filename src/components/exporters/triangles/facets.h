#pragma once
// Curved and simple shapes as triangles, for programs that have nothing else.

#include <optional>

#include "components/exporters/triangles/exported_mesh.h"

namespace etendue {

/// A mesh for a shape, in the object's own coordinates, with its surface coordinates; `curved` tells that it is not the same
/// shape. Nothing: there is none for such a shape.
std::optional<ExportedMesh> facets_of(const SceneObject&, bool& curved);

}  // namespace etendue
