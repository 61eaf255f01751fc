#pragma once
// CoincidentLuminaires: decides which surface is visible where a luminaire coincides with another surface.

#include <memory>
#include <unordered_map>
#include <unordered_set>

#include "etendue/scene.h"

namespace etendue {

/// A lamp may lie in the plane of the ceiling, or two lamps may coincide. Which of the surfaces a ray hits is then decided by
/// rounding, differently for each ray. The other surfaces do not occlude light that starts on one of the surfaces or is sampled
/// there, as rays begin and end beyond the error bounds of points. So that all sampling techniques find the same light, only
/// one of the surfaces exists, as seen from each side:
///   1. a surface that transmits no light, before one that does, as everywhere (resolve_coincident);
///   2. a surface that emits to this side: a lamp in the plane of the ceiling shines;
///   3. of surfaces that do not emit to this side, one that scatters light, before a black one;
///   4. the luminaire that comes first in the scene.
/// A ray that hits any of the surfaces gets the hit on this one (`settle`), and light sampled on any other does not contribute
/// (`in_front`). Only luminaires are searched for coincident surfaces, and rays are checked only if there are any.
class CoincidentLuminaires {
 public:
  /// Tests up to 512 points of each luminaire of a scene. Null: no luminaire coincides with another surface.
  static std::shared_ptr<const CoincidentLuminaires> of(const Scene&);

  /// Replaces the nearest hit of a ray by the hit on the surface that the rules choose.
  void settle(const Scene&, const Ray&, Hit&) const;
  /// Whether the rules choose the luminaire at a point of it, seen from a direction. Enlarges the point's error to include all
  /// coincident surfaces, so that rays begin and end beyond them.
  bool in_front(const Scene&, SurfacePoint&, const Vector3& direction) const;
  /// Enlarges the error of a hit's point to include all coincident surfaces.
  void widen(const Scene&, const Hit&, SurfacePoint&) const;

 private:
  /// Whether the rules choose `a` rather than `b`, seen from a direction.
  bool goes_before(const SurfacePoint& a, const SurfacePoint& b, const Vector3& direction) const;
  struct Pair {
    SurfacePoint luminaire, other;
  };
  struct Pairs;
  void note(const Scene&);
  void look_at(const Scene&, const SceneObject& luminaire, size_t points, Pairs&);

  std::unordered_set<const SceneObject*> met_;           // objects that coincide, as Hit::object refers to them
  std::unordered_map<const SceneObject*, int> numbers_;  // as SurfacePoint::object does, with their order in the fourth rule
};

}  // namespace etendue
