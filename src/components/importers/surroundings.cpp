#include "components/importers/surroundings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "etendue/shader.h"
#include "etendue/volume_shader.h"

namespace etendue {

namespace {

/// Whether a world-space point lies inside a closed object. A copy of the object is prepared for the test, with its current
/// members; the object itself stays unprepared.
bool holds(const SceneObject& object, const DoublePoint3& p) {
  const Ref<SceneObject> body = ref_cast<SceneObject>(copy(object));
  body->shader = nullptr;
  body->emission = nullptr;
  body->interior = nullptr;
  // The point becomes the origin, where floats are most precise.
  body->transform.set_origins(p, body->transform.inner_origin());
  try {
    prepare_tree(*body);
  } catch (const Error&) {  // reported again when the scene is prepared
    return false;
  } catch (const Errors&) {
    return false;
  }
  if (!body->closed()) return false;
  // A ray from a point inside to infinity leaves the body once more than it enters.
  constexpr int most = 1000;
  int depth = 0;
  Ray ray;
  ray.direction = normalize(Vector3{0.3713906f, 0.8571673f, 0.3565862f});
  Hit hit;
  for (int i = 0; i < most && body->intersect(ray, hit); ++i) {
    SurfacePoint point;
    body->surface_point(ray, hit, point);
    depth += dot(point.normal, ray.direction) > 0 ? 1 : -1;
    ray.origin = point.exit(ray.direction);
    hit = {};
  }
  return depth > 0;
}

bool may_let_in(const Component& shader) {
  static constexpr std::array whole = {"Dielectric", "PassThrough", "MaskShader"};
  static constexpr std::array transmitting = {"spec_trans", "transmission_weight"};
  if (std::ranges::find(whole, shader.class_info().name) != whole.end()) return true;
  for (const Member& m : shader.class_info().members) {
    const Value value = get(shader, m.name);
    if (std::ranges::find(transmitting, m.name) != transmitting.end()) {
      const auto* number = value.as<Number>();
      if (!number || number->value > 0) return true;
    }
    if (const auto* part = value.as<Ref<Component>>(); part && dynamic_cast<const Shader*>(part->get()))
      if (may_let_in(**part)) return true;
  }
  return false;
}

/// An invisible box filled with the medium.
Ref<SceneObject> filled_box(Importing& importing, const AroundCamera& around) {
  const Ref<Component> box = importing.make("Box", around.at);
  set_member(*box, "centre", Numbers{{0.5, 0.5, 0.5}, 1, Dimension::none}, around.at);
  set_member(*box, "size", Numbers{{1, 1, 1}, 1, Dimension::none}, around.at);
  set_member(*box, "transform", *around.box, around.at);
  set_member(*box, "shader", importing.make("PassThrough", around.at), around.at);
  set_member(*box, "interior", around.medium, around.at);
  set_member(*box, "priority", -1, around.at);  // objects inside the box displace its medium
  return ref_cast<SceneObject>(box);
}

}  // namespace

Ref<SceneObject> surroundings_for(Importing& importing, const AroundCamera& around,
                                  const std::vector<Ref<SceneObject>>& world) {
  for (const Ref<SceneObject>& body : around.bodies)
    if (holds(*body, around.camera)) return nullptr;
  const auto* volume = dynamic_cast<const VolumeShader*>(around.medium.get());
  if (!volume) return nullptr;
  if (!volume->homogeneous()) {
    if (around.box) return filled_box(importing, around);
    importing.inexact(
        fmt::format("the medium {} around the camera is left out: its box, which could be filled with it, is not known",
                    around.name),
        around.at);
    return nullptr;
  }
  if (!around.bodies.empty())
    importing.inexact(fmt::format("the medium {} around the camera goes on for ever: no closed body that it is inside of holds "
                                  "the camera",
                                  around.name),
                      around.at);
  const Ref<Component> all = importing.make("Surroundings", around.at);
  set_member(*all, "interior", around.medium, around.at);
  if (std::ranges::any_of(world, [](const Ref<SceneObject>& o) { return o->infinite() && o->luminaire(); })) {
    set_member(*all, "reach", 2, around.at);
    importing.inexact(
        fmt::format(
            "the medium {0} around the camera ends here at twice the radius of the scene: light from infinity would not "
            "get through it without end; {1} dims what it samples of such light by twice the radius, wherever it arrives",
            around.name, around.program),
        around.at);
  }
  return ref_cast<SceneObject>(all);
}

void let_medium_go_on(Importing& importing, const AroundCamera& around, SceneObject& body, bool everywhere, Location at) {
  if (!around.medium || !body.shader || body.interior || !may_let_in(*body.shader)) return;
  if (everywhere)
    body.interior = ref_cast<VolumeShader>(around.medium);
  else
    importing.inexact(
        fmt::format("the medium {} does not go on inside of this body, as it does in {}", around.name, around.program), at);
}

}  // namespace etendue
