#pragma once

#include "describe/guard.h"
#include "etendue/shader.h"

namespace etendue {

/// How a shader scatters at a point. What its bind throws is told with its class; that costs nothing while nothing is thrown.
inline const Scatter* bound(const Shader& shader, const SurfacePoint& p, const Wavelengths& w, Arena& arena) {
  try {
    return shader.bind(p, w, arena);
  } catch (...) {
    blame(shader, "binding");
  }
}

}  // namespace etendue
