// What rays meet in a scene.

#include "etendue/transport/ray_tree.h"
#include "etendue/transport/visibility.h"
#include "points.h"

namespace etendue::python {

namespace {

/// The media around the origin of a ray; null: the scene has no objects that a ray can be inside of.
MediumStack* media_before(const RayRows& rays, size_t i, const Scene& scene, const Ray& ray, MediumStack& stack) {
  if (!rays.media) return media_around(scene, ray, stack);
  stack = rays.media->stacks[rays.media->count == 1 ? 0 : i];
  return &stack;
}

/// A ray that meets nothing: FoundPoint::escaped.
void note_escape(const Ray& ray, FoundPoint& found) {
  found.distance = infinity;
  found.point = {};
  found.point.position = ray.origin;
  found.point.ray_direction = ray.direction;
  found.point.time = ray.time;
}

Points* nearest(nb::handle part, size_t count, const nb::tuple& given, bool tracks) {
  const std::shared_ptr<const Snapshot> snapshot = snapshot_of<Scene>(part, "a scene");
  const RayRows rays(given);
  if (rays.media && rays.media->scene != snapshot)
    throw Error("the rays left points of another scene, or of this one before an edit: find the points again by nearest");
  const Scene& scene = snapshot->as<Scene>();
  tracks = tracks && scene.has_interiors();
  auto points = std::make_unique<Points>(count, snapshot, tracks);
  for_all(count, [&](size_t i, Arena&) {
    FoundPoint& found = *new (&points->at[i]) FoundPoint;
    Ray ray;
    const bool goes = rays.at(i, *snapshot, ray);
    found.spread = ray.spread;
    found.of_camera = ray.of_camera;
    const Point3 origin = ray.origin;
    const float maximum = ray.maximum;
    MediumStack* const media = tracks ? new (&points->media[i]) MediumStack : nullptr;
    Hit hit;
    if (!goes) return note_escape({.origin = origin, .direction = {}, .time = 0}, found);
    if (media) media_before(rays, i, scene, ray, *media);
    if (!meet_surface(scene, ray, media, hit, found.point)) {
      ray.origin = origin;
      return note_escape(ray, found);
    }
    // Boundaries that are hidden by an object of higher priority were crossed on the way.
    found.distance = ray.origin == origin ? hit.distance : distance(origin, found.point.position);
    found.remaining = maximum - found.distance;
  });
  return points.release();
}

nb::object occluded(nb::handle part, size_t count, const nb::tuple& given) {
  const std::shared_ptr<const Snapshot> snapshot = snapshot_of<Scene>(part, "a scene");
  const RayRows rays(given);
  const Scene& scene = snapshot->as<Scene>();
  Answers<bool> blocked({count});
  for_all(count, [&](size_t i, Arena&) {
    Ray ray;
    blocked.set(i, rays.at(i, *snapshot, ray) && scene.any(ray));
  });
  return blocked.take();
}

/// Calls call(i, ray, first point, usable, arena) for each item, with the ray from one point to the other, which begins and
/// ends just beside their surfaces.
template <class F>
void for_segments(const Snapshot& scene, size_t count, const Points& a, const Points& b, const F& call) {
  const Vector3 from_a = Vector3(a.origin() - scene.origin()), from_b = Vector3(b.origin() - scene.origin());
  for_all(count, [&](size_t i, Arena& arena) {
    const FoundPoint &begin = a.row(i), &end = b.row(i);
    SurfacePoint p = begin.point, q = end.point;
    p.position = p.position + from_a;
    q.position = q.position + from_b;
    const bool usable = begin.exists() && end.exists() && !(p.position == q.position);
    call(i, usable ? p.towards(q) : Ray{}, p, usable, arena);
  });
}

nb::object visible(nb::handle part, size_t count, const Points& a, const Points& b) {
  const std::shared_ptr<const Snapshot> snapshot = snapshot_of<Scene>(part, "a scene");
  require_present(a, snapshot);
  require_present(b, snapshot);
  Answers<bool> seen({count});
  for_segments(*snapshot, count, a, b, [&](size_t i, const Ray& ray, const SurfacePoint&, bool usable, Arena&) {
    seen.set(i, usable && !snapshot->as<Scene>().any(ray));
  });
  return seen.take();
}

/// The media on the side of a ray that leaves a point; null: the scene has no objects that a ray can be inside of.
const MediumStack* media_after(const Scene& scene, const SurfacePoint& point, const Ray& ray, MediumStack& stack) {
  if (!point.media) return media_around(scene, ray, stack);
  stack = *point.media;
  if (dot(point.normal, ray.direction) * dot(point.normal, point.ray_direction) > 0)
    cross_boundary(stack, *point.object, point.normal, ray.direction);
  return &stack;
}

nb::object transmittance(nb::handle part, size_t count, const Points& a, const Points& b, const nb::tuple& wavelengths,
                         nb::handle sampler, std::uint64_t seed) {
  const std::shared_ptr<const Snapshot> snapshot = snapshot_of<Scene>(part, "a scene");
  require_present(a, snapshot);
  require_present(b, snapshot);
  const std::shared_ptr<const Snapshot> numbers = snapshot_of<Sampler>(sampler, "a sampler");
  const Scene& scene = snapshot->as<Scene>();
  const WavelengthRows rows = wavelength_rows(wavelengths);
  Answers<float> values({count, rows.count()});
  for_segments(*snapshot, count, a, b, [&](size_t i, const Ray& ray, const SurfacePoint& from, bool usable, Arena& arena) {
    if (!usable) return rows.clear(values[i]);
    MediumStack stack;
    const MediumStack* const media = media_after(scene, from, ray, stack);
    const auto item = std::uint32_t(i);
    NumberStream stream(numbers->as<Sampler>(), SampleKey(seed, int(item & 0xffff), int(item >> 16), 0));
    rows.fill(i, values[i], [&](const Wavelengths& w) { return shadow_transmittance(scene, ray, media, w, stream, arena); });
  });
  return values.take();
}

}  // namespace

void bind_scene_questions(nb::module_& m) {
  m.def("prepare_snapshot", [](nb::handle part) { snapshot_of(part); });
  m.def("scene_nearest", &nearest, nb::rv_policy::take_ownership);
  m.def("scene_occluded", &occluded);
  m.def("scene_visible", &visible);
  m.def("scene_transmittance", &transmittance);
}

}  // namespace etendue::python
