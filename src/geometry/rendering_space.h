#pragma once
// Chooses the points relative to which the objects of a scene store their float coordinates; see
// docs/decisions/020-rendering-space.md.

#include "etendue/scene.h"

namespace etendue {

/// Sets, for all objects in a scene at any depth, the origins of their float coordinates; `centre` is the origin of the scene
/// itself, in world space. To be called before the objects are prepared. A space placed once has its origin at `centre`,
/// transformed into this space at the given time. A space placed several times, or shared by several owners, keeps its own
/// origin, unless it is a scene that finds its objects far from there.
void count_from(Scene& scene, const DoublePoint3& centre, float time);

}  // namespace etendue
