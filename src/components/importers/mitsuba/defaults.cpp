// Mitsuba's defaults for scenes without a sensor, integrator or emitter.

#include <cmath>

#include "converter.h"
#include "etendue/scene_object.h"

namespace etendue::mitsuba {

namespace {

/// The bounding box of all finite objects. Copies of the objects are prepared, as only prepared objects have bounds.
Bounds3 bounds_of(const std::vector<Ref<SceneObject>>& world) {
  Bounds3 all;
  for (const Ref<SceneObject>& object : world) {
    if (object->infinite() || object->delta()) continue;
    const Ref<SceneObject> body = ref_cast<SceneObject>(copy(*object));
    body->shader = nullptr;
    body->emission = nullptr;
    body->interior = nullptr;
    try {
      prepare_tree(*body);
    } catch (const Error&) {  // reported again when the scene is prepared
      continue;
    } catch (const Errors&) {
      continue;
    }
    if (!body->unbounded()) all.add(body->bounds());
  }
  return all;
}

}  // namespace

// A field of view of 45 degrees across the image, looking along +z from before the centre of all shapes, at a distance from
// which their largest lateral extent is visible.
Ref<Component> Converter::default_camera(const Element& scene, const std::vector<Ref<SceneObject>>& world) {
  Ref<Component> camera = importing_.make("PerspectiveCamera", scene.at);
  set_member(*camera, "fov", 45, scene.at);
  set_member(*camera, "fov_axis", "width", scene.at);
  const Bounds3 all = bounds_of(world);
  if (all.empty()) {
    importing_.inexact("the scene has no sensor: a camera at the origin looks along +z", scene.at);
    return camera;
  }
  importing_.inexact("the scene has no sensor: a camera before all shapes looks along +z, as in Mitsuba 0.x", scene.at);
  const Vector3 size = all.diagonal();
  const Point3 centre = all.centre();
  const double away = double(std::max(size.x, size.y)) / (2 * std::tan(std::numbers::pi / 8));
  const double z = double(all.low.z) - away;
  set_member(*camera, "from", Numbers{{double(centre.x), double(centre.y), z}, 1, Dimension::none}, scene.at);
  set_member(*camera, "to", Numbers{{double(centre.x), double(centre.y), z + 1}, 1, Dimension::none}, scene.at);
  return camera;
}

// Mitsuba's default: a sky twice as bright, with a sun of fifteen times the diameter.
Ref<SceneObject> Converter::default_sky(const Element& scene) {
  importing_.inexact("the scene has no emitter: sky and sun shine, as in Mitsuba 0.x, but not from below the horizon",
                     scene.at);
  Element sky;
  sky.tag = "emitter";
  sky.type = "sunsky";
  sky.at = scene.at;
  sky.old = true;
  const auto say = [&](const char* name, auto value) { sky.properties.push_back({name, scene.at, std::move(value)}); };
  TransformValue turned;
  turned.transform = AnimatedTransform(Transform::rotate(-120 * std::numbers::pi / 180, {0, 1, 0}));
  say("to_world", turned);
  say("scale", 2.0);
  say("sun_radius_scale", 15.0);
  return emitter(sky);
}

}  // namespace etendue::mitsuba
