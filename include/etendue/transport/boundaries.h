#pragma once
// What a path does to its medium stack when it crosses a surface.

#include "etendue/scene.h"
#include "etendue/transport/medium_stack.h"

namespace etendue {

/// Boundaries a path may cross straight on from one vertex to the next. One that crosses more is held in place by rounding, or
/// by an object whose distances are wrong: it ends, rather than go on, and take memory, for ever.
constexpr int most_crossings = 1000;

/// The path goes through the surface of an object in a direction. One that is not closed has no inside: a sheet of it
/// bounds nothing.
inline void cross_boundary(MediumStack& media, const SceneObject& object, const Normal3& normal, const Vector3& direction) {
  if (enterable(object)) {
    if (dot(normal, direction) < 0)
      media.enter(object);
    else
      media.leave(object);
  }
  media.cross_others();
}

/// Whether the object's boundary means nothing here because the path is inside something of higher priority.
inline bool hidden_by_priority(const MediumStack& media, const SceneObject& object) {
  if (!object.shader || media.visible(object)) return false;
  return object.shader->transmits() || enterable(object);
}

/// Whether the first counts where the boundaries of both lie in one place: what lets no light in before what does, sheets
/// before bodies, higher priorities before lower ones. Of two that are alike neither does.
bool boundary_goes_before(const SceneObject&, const SceneObject&);

/// Surfaces that lie no farther from a point than this, across its surface, are in one place with it.
float reach_of_coincidence(const Scene&, const SurfacePoint&);

/// Other surfaces in the same place as a hit, within the error of its position, each once. `probe` is the ray, across the
/// surface, that found them.
void coincident_hits(const Scene&, const Ray&, const Hit&, const SurfacePoint&, Ray& probe, HitList&);

/// After a path has come to a surface, decides which one it has come to where several lie in the same place, and lets `media`
/// know of the others. One that lets nothing through comes first (a glass stands on the table, with no air between), then
/// that of the highest priority, as everywhere.
void resolve_coincident(const Scene&, const Ray&, Hit&, SurfacePoint&, MediumStack& media);

}  // namespace etendue
