#pragma once
// Rays, and what they hit.

#include "etendue/core/vector.h"

namespace etendue {

class SceneObject;

/// The points origin + t * direction for t in (0, maximum). The direction has unit length in the outermost scene; in object
/// spaces and nested scenes it is transformed and not normalized, so that t stays the same.
struct Ray {
  Point3 origin;
  Vector3 direction;
  float maximum = infinity;
  float time = 0;  ///< [s]
  /// A ray cone, for texture filtering: its width [m] at the origin and the growth of the width per distance (Akenine-Möller
  /// et al. 2021, "Improved shader and texture level of detail using ray cones").
  float width = 0, spread = 0;
  /// Whether the ray is the segment between the camera and the first vertex, traced in either direction. It ignores objects
  /// that are invisible to the camera (SceneObject::visible_to_camera).
  bool of_camera = false;

  Point3 operator()(float t) const { return origin + t * direction; }
};

/// The result of an intersection test (ShapeIntersection in pbrt, PreliminaryIntersection in Mitsuba), from which the
/// SurfacePoint can be computed on demand.
struct Hit {
  static constexpr int deepest_nesting = 8;

  float distance = infinity;                   ///< t along the ray
  const SceneObject* object = nullptr;         ///< the innermost object; null when nothing was hit
  std::uint32_t primitive = 0;                 ///< index of the part of the object (a triangle of a mesh)
  float u = 0, v = 0;                          ///< coordinates on the part, as defined by the object
  int depth = 0;                               ///< number of nested scenes that contain the object
  const SceneObject* scenes[deepest_nesting];  ///< these scenes and instances, innermost first; only the first `depth` are set

  explicit operator bool() const { return object != nullptr; }
};

}  // namespace etendue
