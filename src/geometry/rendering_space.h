#pragma once
// Chooses the origins relative to which the objects of a scene store their float coordinates; see
// docs/decisions/020-rendering-space.md.

#include "etendue/scene.h"

namespace etendue {

/// Sets, for all objects in a scene at any depth, the origins of their float coordinates; `origin` is the origin of rendering
/// space, in world space. To be called before the objects are prepared. A space placed once has this point as its origin,
/// transformed into this space at the given time. A space placed several times, or shared by several owners, keeps its own
/// origin, unless it is a scene that finds its objects far from there.
void set_rendering_origin(Scene& scene, const DoublePoint3& origin, float time);

}  // namespace etendue
