#pragma once
// Boundaries: how the medium stack of a path changes at a surface, which surfaces are hidden by an object of higher priority,
// and which of several coincident surfaces a ray hits.

#include "etendue/scene.h"
#include "etendue/transport/medium_stack.h"

namespace etendue {

/// The maximum number of boundaries that a path crosses between two vertices. A path that crosses more is stuck, by rounding or
/// at an object with wrong distances: it is ended, as otherwise it would continue, and allocate memory, without end.
constexpr int most_crossings = 1000;

/// Updates the stack of a path that goes through the surface of an object in a direction. An object that is not closed has no
/// inside, and changes nothing: it is a sheet.
inline void cross_boundary(MediumStack& media, const SceneObject& object, const Normal3& normal, const Vector3& direction) {
  if (enterable(object)) {
    if (dot(normal, direction) < 0)
      media.enter(object);
    else
      media.leave(object);
  }
  media.cross_others();
}

/// Whether the object's boundary is hidden because the path is inside an object of higher priority.
inline bool hidden_by_priority(const MediumStack& media, const SceneObject& object) {
  if (!object.shader || media.visible(object)) return false;
  return object.shader->transmits() || enterable(object);
}

/// Whether the boundary of the first object takes precedence where both coincide: opaque surfaces before those that transmit,
/// sheets before closed objects, higher priorities before lower ones. Of two equal objects neither does.
bool boundary_goes_before(const SceneObject&, const SceneObject&);

/// The distance [m] along the normal of a point within which other surfaces count as coincident with it.
float reach_of_coincidence(const Scene&, const SurfacePoint&);

/// Finds the other surfaces that coincide with a hit, within the error of its position, each once. `probe` is the ray along the
/// normal by which they were found.
void coincident_hits(const Scene&, const Ray&, const Hit&, const SurfacePoint&, Ray& probe, HitList&);

/// Called when a path hits a surface: where several surfaces coincide, selects the one that the path hits, and adds the others
/// to `media`. An opaque surface comes first (a glass stands on the table, with no air between), then that of the highest
/// priority, as everywhere.
void resolve_coincident(const Scene&, const Ray&, Hit&, SurfacePoint&, MediumStack& media);

}  // namespace etendue
