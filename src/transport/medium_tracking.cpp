#include "transport/medium_tracking.h"

namespace etendue {
namespace {

bool lets_in(const SceneObject& object) { return object.shader && object.shader->transmits(); }

/// Whether the first counts where the boundaries of both lie in one place.
bool before(const SceneObject& a, const SceneObject& b) {
  if (lets_in(a) != lets_in(b)) return !lets_in(a);
  if (a.priority != b.priority) return a.priority > b.priority;
  // What only bounds a medium gives way to what refracts.
  return a.shader->possible_lobes() != pass_through && b.shader->possible_lobes() == pass_through;
}

}  // namespace

void coincident_hits(const Scene& scene, const Ray& ray, const SurfacePoint& point, Ray& probe, HitList& list) {
  // Each of two surfaces in one place is found within its error, which may be nothing: in a plane z = 0, say.
  const float largest = std::max({std::abs(point.position.x), std::abs(point.position.y), std::abs(point.position.z)});
  const float reach = 4 * point.error + 1e-7f * (largest + scene.radius());
  probe = ray;
  probe.direction = std::copysign(1.0f, dot(point.normal, ray.direction)) * Vector3(point.normal);
  probe.origin = point.position - reach * probe.direction;
  probe.maximum = 2 * reach;
  HitList all;
  scene.all(probe, all);
  for (int i = 0; i < all.size; ++i) {
    bool known = all.hits[i].object == point.object;
    for (int k = 0; k < list.size; ++k) known |= list.hits[k].object == all.hits[i].object;
    if (!known) list.add(all.hits[i]);
  }
}

void settle_coincident(const Scene& scene, const Ray& ray, Hit& hit, SurfacePoint& point, MediumStack& media) {
  media.forget_others();
  if (!lets_in(*hit.object)) return;
  HitList others;
  Ray probe;
  coincident_hits(scene, ray, point, probe, others);
  if (others.size == 0) return;
  const float error = length(probe.origin - point.position);  // the next ray must start beyond all of them

  const SceneObject* first = hit.object;
  for (int i = 0; i < others.size; ++i)
    if (before(*others.hits[i].object, *first)) first = others.hits[i].object;
  const auto note = [&](const SceneObject& object, const Normal3& normal) {
    if (&object != first && lets_in(object) && object.closed()) media.note_other(object, dot(normal, ray.direction) < 0);
  };
  note(*point.object, point.normal);
  const float distance = hit.distance, footprint = point.footprint;
  for (int i = 0; i < others.size; ++i) {
    SurfacePoint other;
    scene.locate(probe, others.hits[i], other);
    note(*other.object, other.normal);
    if (other.object != first) continue;
    hit = others.hits[i];
    hit.distance = distance;
    point = other;
    point.footprint = footprint;
    point.footprint_cosine = std::abs(dot(point.normal, ray.direction));
    point.ray_direction = ray.direction;
  }
  point.error = std::max(point.error, error);
  if (!lets_in(*first)) media.forget_others();
}

}  // namespace etendue
