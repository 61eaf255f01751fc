// Warns of cameras that see no object, or little of an imported model, or stand inside an opaque one.

#include <fmt/format.h>

#include <cmath>

#include "etendue/importer.h"
#include "etendue/transport/medium_stack.h"
#include "scene_warnings.h"

namespace etendue {
namespace {

constexpr int side = 24;  // number of rays across the film, and down it

std::string name_of(const SceneObject& object) {
  if (object.origin && !object.origin->name.empty()) return "'" + object.origin->name + "'";
  return "the " + object.class_info().name;
}

/// One of side x side rays, spread over the film and over the time the shutter is open.
Ray camera_ray(const Job& job, int x, int y) {
  const Camera& camera = *job.camera;
  const float part = (float(x + side * y) + 0.5f) / (side * side);
  const Point2 film{float(job.image->width) * (float(x) + 0.5f) / side, float(job.image->height) * (float(y) + 0.5f) / side};
  Ray ray = camera.ray(film, {0.5f, 0.5f}, camera.shutter_open + part * (camera.shutter_close - camera.shutter_open));
  ray.of_camera = true;
  return ray;
}

/// Whether a ray passes a box: within `slack` radians of its bounding sphere.
bool comes_near(const Ray& ray, const Bounds3& box, float slack) {
  const Vector3 to = box.centre() - ray.origin;
  const float radius = length(box.diagonal()) / 2, along = dot(to, ray.direction), distance = length(to);
  if (distance <= radius) return true;
  const float across = std::sqrt(std::max(distance * distance - along * along, 0.0f));
  return along > 0 && along - radius <= ray.maximum && across <= radius + slack * along;
}

/// The bounds of the finite objects that the camera does not ignore.
Bounds3 visible_bounds(const Scene& scene) {
  Bounds3 all;
  for (const Ref<SceneObject>& object : scene.objects) {
    if (object->infinite() || !object->visible_to_camera) continue;
    const Bounds3 box = object->bounds();
    if (!box.empty()) all.add(box);
  }
  return all;
}

/// Warns if all objects, within `all`, are outside the camera's view, and returns whether they are.
bool sees_nothing(const Job& job, const Bounds3& all, std::vector<SceneWarning>& list) {
  const Camera& camera = *job.camera;
  const Vector3 first = camera_ray(job, 0, side / 2).direction, last = camera_ray(job, side - 1, side / 2).direction;
  const Vector3 low = camera_ray(job, side / 2, 0).direction, high = camera_ray(job, side / 2, side - 1).direction;
  const float spacing =
      2 * std::max(std::acos(std::clamp(dot(first, last), -1.0f, 1.0f)), std::acos(std::clamp(dot(low, high), -1.0f, 1.0f))) /
      side;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      if (comes_near(camera_ray(job, x, y), all, spacing + 1e-4f)) return false;
  const Ray middle =
      camera.ray({0.5f * float(job.image->width), 0.5f * float(job.image->height)}, {0.5f, 0.5f}, camera.shutter_open);
  const Point3 c = all.centre();
  const Camera::Reach reach = camera.reach(middle);
  const bool clips = reach.nearest > 0 || reach.farthest < infinity;
  list.push_back(
      {"sees nothing",
       fmt::format("the camera sees none of the objects: it looks from ({:.4g}, {:.4g}, {:.4g}) along ({:.3g}, {:.3g}, "
                   "{:.3g}), and they lie within {:.4g} m around ({:.4g}, {:.4g}, {:.4g}); look there with 'to'{}",
                   middle.origin.x, middle.origin.y, middle.origin.z, middle.direction.x, middle.direction.y,
                   middle.direction.z, length(all.diagonal()) / 2, c.x, c.y, c.z,
                   clips ? ", or check 'near_clip' and 'far_clip'" : ""),
       camera.location_of("to")});
  return true;
}

/// Warns if the objects of an imported model fill little of the picture: its camera may be meant for another unit of length.
void sees_little(const Job& job, std::vector<SceneWarning>& list) {
  const Location at = job.location_of("camera");
  if (!at.known() || !importer_of(at.file)) return;
  constexpr double least = 0.01;
  int met = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      Hit hit;
      met += job.scene->nearest(camera_ray(job, x, y), hit);
    }
  if (met >= least * side * side) return;
  list.push_back({"sees little",
                  fmt::format("the objects fill less than {:.0f} % of the picture; move the camera nearer, or narrow its view",
                              100 * least),
                  at});
}

/// Warns if the camera is inside an opaque closed object that contains no luminaire.
void stands_in_the_dark(const Job& job, std::vector<SceneWarning>& list) {
  const Scene& scene = *job.scene;
  const Ray start = camera_ray(job, side / 2, side / 2);
  const SceneObject* around = nullptr;
  constexpr int directions = 32;
  for (int i = 0; i < directions; ++i) {  // evenly distributed over the sphere, along a spiral
    Ray ray = start;
    const float z = 1 - (2 * float(i) + 1) / directions, r = std::sqrt(std::max(1 - z * z, 0.0f)), turn = 2.399963f * float(i);
    ray.direction = {r * std::cos(turn), r * std::sin(turn), z};
    ray.maximum = infinity;
    Hit hit;
    if (!scene.nearest(ray, hit)) return;
    SurfacePoint point;
    scene.locate(ray, hit, point);
    const SceneObject& object = point.object->original();
    if (!object.closed() || object.luminaire() || dot(point.normal, ray.direction) < 0) return;
    if (object.shader && (object.shader->possible_lobes() & (transmission_lobes | null_scattering))) return;
    if (around && around != &object) return;
    around = &object;
  }
  const Bounds3 box = around->bounds();
  for (const SceneObject* luminaire : scene.luminaires()) {
    if (luminaire->infinite()) continue;
    const Bounds3 other = luminaire->luminaire_bounds().box;
    bool overlap = true;
    for (int k = 0; k < 3; ++k) overlap &= other.low[k] <= box.high[k] && other.high[k] >= box.low[k];
    if (overlap) return;
  }
  list.push_back({"in the dark",
                  fmt::format("the camera stands inside {}, which does not transmit light, and nothing inside emits light: the "
                              "picture will be black; move the camera out, or add a luminaire",
                              name_of(*around)),
                  job.camera->location_of("from")});
}

}  // namespace

void warn_of_view(const Job& job, std::vector<SceneWarning>& list) {
  const Bounds3 all = job.scene->unbounded() ? Bounds3() : visible_bounds(*job.scene);
  if (!all.empty() && !sees_nothing(job, all, list)) sees_little(job, list);
  if (shows_light(*job.renderer)) stands_in_the_dark(job, list);
}

}  // namespace etendue
