#pragma once
// Transforms that scale to zero along one axis.

#include <optional>

#include "etendue/core/transform.h"

namespace etendue::gltf {

/// An invertible transform without visible change: a flat object gets a thickness of 1e-4 of its size. Nothing: the transform
/// maps everything to a line or a point, which is invisible.
std::optional<Transform> with_thickness(const Transform&);

}  // namespace etendue::gltf
