#pragma once
// CoincidentLuminaires: what is met where a luminaire and another surface lie in one place.

#include <memory>
#include <unordered_map>
#include <unordered_set>

#include "etendue/scene.h"

namespace etendue {

/// A lamp may lie in the plane of the ceiling, or two lamps in one another. Which of the surfaces a ray meets there is then a
/// matter of rounding, another one for each ray; and to light that begins on one of them, or is looked for there, the others
/// are not in the way, as rays begin and end beyond the errors of places. So that all ways to make paths find the same light,
/// one of the surfaces alone is there, seen from either side:
///   1. one that lets no light through, before one that does, as everywhere (resolve_coincident);
///   2. one that sends light to that side: a lamp in the plane of the ceiling shines;
///   3. of those that send none there, one that scatters light, before one that is black;
///   4. the luminaire that stands first in the scene.
/// A ray that meets any of them meets that one (`settle`), and what leaves one of the others does not arrive (`in_front`).
/// Only places on luminaires are looked for, and only if there are such do rays take notice.
class CoincidentLuminaires {
 public:
  /// Looks at some hundred points of each luminaire of a scene. Null: none of them lies in one place with anything else.
  static std::shared_ptr<const CoincidentLuminaires> of(const Scene&);

  /// Replaces the nearest hit of a ray by that of the surface which is there.
  void settle(const Scene&, const Ray&, Hit&) const;
  /// Whether a point of a luminaire is what is there, seen from a direction. If so its error becomes that of all surfaces
  /// there, so that rays begin and end beyond them.
  bool in_front(const Scene&, SurfacePoint&, const Vector3& direction) const;
  /// Of the point of a hit: lets its error be that of all surfaces there.
  void widen(const Scene&, const Hit&, SurfacePoint&) const;

 private:
  /// Whether `a` is what is there, and not `b`, seen from a direction.
  bool goes_before(const SurfacePoint& a, const SurfacePoint& b, const Vector3& direction) const;
  struct Pair {
    SurfacePoint luminaire, other;
  };
  struct Pairs;
  void note(const Scene&);
  void look_at(const Scene&, const SceneObject& luminaire, size_t points, Pairs&);

  std::unordered_set<const SceneObject*> met_;           // what hits name of objects that are in one place with a luminaire
  std::unordered_map<const SceneObject*, int> numbers_;  // and what points on them name, in the order of the fourth rule
};

}  // namespace etendue
