#pragma once
// From which points the objects of a scene count, see docs/decisions/020-rendering-space.md.

#include "etendue/scene.h"

namespace etendue {

/// Tells all objects in a scene, at any depth, from which points they are to count; `centre` is that of the scene itself, in
/// the coordinates of the world. To be called before they are prepared. What stands in one place counts from where `centre` is
/// in its own coordinates, at the time given; what stands in several, or is shared by several, from its own origin, unless it
/// is a scene that finds its objects far from there.
void count_from(Scene& scene, const DoublePoint3& centre, float time);

}  // namespace etendue
