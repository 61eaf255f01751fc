#pragma once
// Shared by delta lights (point and distant lights).

#include "etendue/scene_object.h"

namespace etendue {

/// No ray hits such an object, so a shader or an interior medium would have no effect: throws Error if one is given.
inline void refuse_surface(const SceneObject& object, const char* what) {
  if (object.shader) object.fail("shader", std::string(what) + " has no surface, so it scatters nothing; leave the shader out");
  if (object.interior) object.fail("interior", std::string(what) + " has no inside; leave the interior out");
}

}  // namespace etendue
