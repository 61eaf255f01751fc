#pragma once
// What a path does to its medium stack when it crosses a surface.

#include "etendue/medium_stack.h"

namespace etendue {

/// The path goes through the surface of an object in a direction. One that is not closed has no inside: a sheet of it
/// bounds nothing.
inline void cross_boundary(MediumStack& media, const SceneObject& object, const Normal3& normal, const Vector3& direction) {
  if (!object.closed()) return;
  if (dot(normal, direction) < 0)
    media.enter(object);
  else
    media.leave(object);
}

/// Whether the object's boundary means nothing here because the path is inside something of higher priority.
inline bool hidden_by_priority(const MediumStack& media, const SceneObject& object) {
  return object.shader && object.shader->transmits() && !media.visible(object);
}

}  // namespace etendue
