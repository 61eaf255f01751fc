#pragma once
// What luminaires without extent share.

#include "etendue/scene_object.h"
#include "etendue/shader.h"  // objects own shaders

namespace etendue {

/// No ray meets such an object, so what belongs to a surface or an inside would be ignored: it is refused.
inline void refuse_surface(const SceneObject& object, const char* what) {
  if (object.shader) object.fail("shader", std::string(what) + " has no surface, so it scatters nothing; leave the shader out");
  if (object.interior) object.fail("interior", std::string(what) + " has no inside; leave the interior out");
}

}  // namespace etendue
