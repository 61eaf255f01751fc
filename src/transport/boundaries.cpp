#include "etendue/transport/boundaries.h"

#include "unprepared.h"

namespace etendue {
namespace {

/// Whether light continues behind the surface, in any medium.
bool lets_in(const SceneObject& object) { return object.shader && (object.shader->transmits() || is_sheet(*object.shader)); }

/// Whether the surface is a sheet without a medium inside: behind it light continues in the medium around it.
bool mere_sheet(const SceneObject& object) { return is_sheet(*object.shader) && !enterable(object); }

}  // namespace

bool boundary_goes_before(const SceneObject& a, const SceneObject& b) {
  if (lets_in(a) != lets_in(b)) return !lets_in(a);
  if (!lets_in(a)) return false;
  if (mere_sheet(a) || mere_sheet(b)) return mere_sheet(a) && !mere_sheet(b);
  if (a.priority != b.priority) return a.priority > b.priority;
  // A boundary that only encloses a medium comes after one that refracts.
  return a.shader->possible_lobes() != null_scattering && b.shader->possible_lobes() == null_scattering;
}

float reach_of_coincidence(const Scene& scene, const SurfacePoint& point) {
  // Each of two coincident surfaces is found within its error bound, which may be zero (in a plane z = 0, for example): then
  // within a few roundings of the position.
  const float largest = std::max({std::abs(point.position.x), std::abs(point.position.y), std::abs(point.position.z)});
  return 4 * point.error + 2.5e-7f * largest + 1e-9f * scene.radius();
}

namespace {

/// Whether two hits are on the same object in the same instance: one object may be in several scenes.
bool same_thing(const Hit& a, const Hit& b) {
  if (a.object != b.object || a.depth != b.depth) return false;
  for (int i = 0; i < a.depth; ++i)
    if (a.scenes[i] != b.scenes[i]) return false;
  return true;
}

}  // namespace

bool enterable_once_prepared(const SceneObject& object) {
  if (!object.shader) return false;
  try {
    const Ref<SceneObject> twin = ref_cast<SceneObject>(copy(object));
    prepare_tree(*twin);
    return enterable(*twin);
  } catch (const Error&) {  // the error is reported when the object itself is prepared
  } catch (const Errors&) {
  }
  return false;
}

void coincident_hits(const Scene& scene, const Ray& ray, const Hit& hit, const SurfacePoint& point, Ray& probe, HitList& list) {
  const float reach = reach_of_coincidence(scene, point);
  probe = ray;
  probe.direction = std::copysign(1.0f, dot(point.normal, ray.direction)) * Vector3(point.normal);
  probe.origin = point.position - reach * probe.direction;
  probe.maximum = 2 * reach;
  HitList all;
  all.add(hit);  // so that the scene need not report it again
  scene.all(probe, all);
  for (int i = 1; i < all.size; ++i) {
    bool known = same_thing(all.hits[i], hit);
    for (int k = 0; k < list.size; ++k) known |= same_thing(all.hits[i], list.hits[k]);
    if (!known) list.add(all.hits[i]);
  }
}

void resolve_coincident(const Scene& scene, const Ray& ray, Hit& hit, SurfacePoint& point, MediumStack& media) {
  media.forget_others();
  if (!lets_in(*hit.object)) return;
  HitList others;
  Ray probe;
  coincident_hits(scene, ray, hit, point, probe, others);
  if (others.size == 0) return;
  const float error = length(probe.origin - point.position);  // the next ray must start beyond all of these surfaces

  int first = -1;  // the hit itself
  for (int i = 0; i < others.size; ++i)
    if (boundary_goes_before(*others.hits[i].object, first < 0 ? *hit.object : *others.hits[first].object)) first = i;
  const auto note = [&](const SceneObject& object, const Normal3& normal) {
    if (enterable(object)) media.note_other(object, dot(normal, ray.direction) < 0);
  };
  if (first >= 0) note(*point.object, point.normal);
  const float footprint = point.footprint;
  SurfacePoint chosen = point;
  for (int i = 0; i < others.size; ++i) {
    SurfacePoint other;
    scene.locate(probe, others.hits[i], other);
    if (i == first)
      chosen = other;
    else
      note(*other.object, other.normal);
  }
  if (first >= 0) {
    const float distance = hit.distance;
    hit = others.hits[first];
    hit.distance = distance;
    point = chosen;
    point.footprint = footprint;
    point.footprint_cosine = std::abs(dot(point.normal, ray.direction));
    point.ray_direction = ray.direction;
  }
  point.error = std::max(point.error, error);
  if (!lets_in(*point.object)) media.forget_others();
}

}  // namespace etendue
