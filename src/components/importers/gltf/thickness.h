#pragma once
// What is scaled to nothing along an axis.

#include <optional>

#include "etendue/core/transform.h"

namespace etendue::gltf {

/// A transform that can be undone and moves nothing seen: what is flat gets a ten thousandth of its size as its thickness.
/// None: it makes a line or a point of everything, of which nothing is seen.
std::optional<Transform> with_thickness(const Transform&);

}  // namespace etendue::gltf
