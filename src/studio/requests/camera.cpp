// Requests that move a camera: each is an edit of the text, and is shown at once at low resolution.

#include <fmt/format.h>

#include "etendue/scene_object.h"
#include "requests.h"

namespace etendue::studio {

namespace {

/// Pause in a camera movement after which the picture is rendered at full resolution.
constexpr auto rest = std::chrono::milliseconds(300);

/// Switches to low resolution until the camera rests.
void begin_movement(Studio& studio) {
  studio.fine_at = std::chrono::steady_clock::now() + rest;
  if (studio.coarse.exchange(true)) return;
  studio.apply_overrides();
}

void end_movement(Studio& studio) {
  studio.fine_at.reset();
  ++studio.movement;
  if (studio.coarse.exchange(false)) studio.apply_overrides();
}

/// Applies the edits of one step of a camera movement.
Json moved(const Call& call, const Ref<Component>& camera, const std::function<void(TextEditor&)>& edit) {
  Studio& studio = call.studio;
  if (!call.flag("final")) begin_movement(studio);
  Json reply;
  try {
    TextEditor editor = editor_for(call);
    edit(editor);
    const std::string merge = fmt::format("view {} {}", studio.document().id_of(*camera), studio.movement);
    reply = tell(call, studio.document().apply(editor.text(), {"move the camera", merge}));
  } catch (...) {
    if (call.flag("final")) end_movement(studio);
    throw;
  }
  if (call.flag("final")) end_movement(studio);
  return reply;
}

Ref<Component> camera_of(const Call& call) {
  static_cast<void>(call.studio.valid_render());
  if (call.has("component")) return call.component();
  return Ref<Component>(const_cast<Camera*>(call.studio.document().job().camera.get()));
}

Json view(const Call& call) {
  const Ref<Component> camera = camera_of(call);
  if (!call.has("edits") || !call.request["edits"].is_array()) throw RequestError("bad_request", "'edits' must be a list");
  return moved(call, camera, [&](TextEditor& editor) {
    for (const Json& one : call.request["edits"]) {
      if (!one.is_object()) throw RequestError("bad_request", "an edit is an object");
      const Call part{call.studio, call.browser, one, call.id};
      const Ref<Component> target = part.has("component") ? part.component() : camera;
      editor.set(slot(target, part.text("member"), part.index()), part.text("text"));
    }
  });
}

// ---- cameras with a position and a target point -----------------------------------------------------------------------------

/// Position, target and up vector of such a camera [m].
struct Pose {
  DoublePoint3 from, to;
  DoubleVector3 up;
};

DoubleVector3 numbers_of(const Component& camera, const char* member) {
  const Member* found = camera.class_info().find(member);
  const Value value = found ? found->get(camera, *found) : Value();
  const auto* numbers = value.as<Numbers>();
  if (!numbers || numbers->values.size() != 3)
    throw Error(fmt::format("{} has no '{}': it is not moved this way", camera.class_info().name, member));
  return {numbers->values[0], numbers->values[1], numbers->values[2]};
}

Pose pose_of(const Component& camera) {
  Pose pose;
  pose.from = DoublePoint3{} + numbers_of(camera, "from");
  pose.to = DoublePoint3{} + numbers_of(camera, "to");
  pose.up = numbers_of(camera, "up");
  return pose;
}

/// A point in the unit that it was written in, with as many digits as affect the picture.
std::string point_text(const TextEditor& editor, const Slot& s, const DoublePoint3& p, double scale) {
  std::string unit = "m";
  const std::string before = editor.written(s);
  if (const size_t at = before.rfind(']'); at != std::string::npos) {
    std::string word = before.substr(at + 1);
    std::erase(word, ' ');
    if (const Unit* found = find_unit(word); found && found->dimension == Dimension::length) unit = word;
  }
  const double factor = find_unit(unit)->factor;
  const double digit = std::pow(10, std::floor(std::log10(std::max(scale, 1e-30) / factor)) - 4);
  const auto rounded = [&](double x) {
    const double steps = std::round(x / factor / digit);
    return fmt::format("{:.10g}", digit < 1 ? steps / std::round(1 / digit) : steps * digit);
  };
  return fmt::format("[{}, {}, {}] {}", rounded(p.x), rounded(p.y), rounded(p.z), unit);
}

Json placed(const Call& call, const Ref<Component>& camera, const Pose& pose) {
  const double scale = length(pose.to - pose.from);
  if (!(scale > 0) || !std::isfinite(scale)) throw Error("the camera would be where it looks at");
  return moved(call, camera, [&](TextEditor& editor) {
    const Slot from = slot(camera, "from"), to = slot(camera, "to");
    editor.set(from, point_text(editor, from, pose.from, scale));
    editor.set(to, point_text(editor, to, pose.to, scale));
  });
}

/// Rotates a vector about an axis by an angle [rad].
DoubleVector3 turned(const DoubleVector3& v, const DoubleVector3& axis, double angle) {
  const DoublePoint3 p = Transform::rotate(angle, axis)(DoublePoint3{} + v);
  return p - DoublePoint3{};
}

DoubleVector3 normalize(const DoubleVector3& v) { return 1 / length(v) * v; }

/// The axes of the image: view direction, right and up.
struct Axes {
  DoubleVector3 forward, right, up;
};
Axes axes_of(const Pose& pose) {
  Axes a;
  a.forward = normalize(pose.to - pose.from);
  DoubleVector3 right = cross(a.forward, pose.up);
  if (length(right) < 1e-9) right = cross(a.forward, DoubleVector3{0, 0, 1});
  if (length(right) < 1e-9) right = DoubleVector3{1, 0, 0};
  a.right = normalize(right);
  a.up = cross(a.right, a.forward);
  return a;
}

Json orbit(const Call& call) {
  const Ref<Component> camera = camera_of(call);
  Pose pose = pose_of(*camera);
  DoublePoint3 about = pose.to;
  if (call.has("about")) {
    const Json& p = call.request["about"];
    if (!p.is_array() || p.size() != 3 || !std::all_of(p.begin(), p.end(), [](const Json& x) { return x.is_number(); }))
      throw RequestError("bad_request", "'about' must be three numbers");
    about = {p[0].get<double>(), p[1].get<double>(), p[2].get<double>()};
  }
  const double x = call.number_or("x", 0);
  double y = call.number_or("y", 0);
  // Limits the elevation, since the camera would turn upside down beyond the poles.
  const DoubleVector3 up = normalize(pose.up), away = normalize(pose.from - about);
  const double height = std::asin(std::clamp(dot(away, up), -1.0, 1.0));
  constexpr double highest = 1.55;
  y = std::clamp(height + y, -highest, highest) - height;
  const Axes axes = axes_of(pose);
  const auto turn = [&](const DoublePoint3& p) { return about + turned(turned(p - about, axes.right, -y), up, x); };
  pose.from = turn(pose.from);
  pose.to = turn(pose.to);
  return placed(call, camera, pose);
}

/// Moves the camera by fractions of the visible width at the distance of `to`.
Json pan(const Call& call) {
  const Ref<Component> camera = camera_of(call);
  Pose pose = pose_of(*camera);
  const Axes axes = axes_of(pose);
  double size = length(pose.to - pose.from);
  if (const Member* fov = camera->class_info().find("fov")) {
    const Value value = fov->get(*camera, *fov);
    if (const auto* angle = value.as<Number>()) size *= 2 * std::tan(angle->value / 2);
  }
  const DoubleVector3 by = -call.number_or("x", 0) * size * axes.right + call.number_or("y", 0) * size * axes.up;
  pose.from = pose.from + by;
  pose.to = pose.to + by;
  return placed(call, camera, pose);
}

Json dolly(const Call& call) {
  const Ref<Component> camera = camera_of(call);
  Pose pose = pose_of(*camera);
  const double ratio = call.number("x");
  if (!(ratio > 1e-3 && ratio < 1e3)) throw RequestError("bad_request", "'x' must be a ratio of distances from 0.001 to 1000");
  pose.from = pose.to + ratio * (pose.from - pose.to);
  return placed(call, camera, pose);
}

/// Moves the camera by metres along the image axes, and rotates the view direction by radians.
Json fly(const Call& call) {
  const Ref<Component> camera = camera_of(call);
  Pose pose = pose_of(*camera);
  const Axes axes = axes_of(pose);
  const DoubleVector3 by =
      call.number_or("right", 0) * axes.right + call.number_or("up", 0) * axes.up + call.number_or("forward", 0) * axes.forward;
  pose.from = pose.from + by;
  const DoubleVector3 view =
      turned(turned(pose.to + by - pose.from, axes.right, call.number_or("y", 0)), normalize(pose.up), -call.number_or("x", 0));
  pose.to = pose.from + view;
  return placed(call, camera, pose);
}

Json frame(const Call& call) {
  static_cast<void>(call.studio.valid_render());
  const Job& job = call.studio.document().job();
  const Ref<Component> camera(const_cast<Camera*>(job.camera.get()));
  const Ref<Component> part = call.component();
  const auto* object = dynamic_cast<const SceneObject*>(part.get());
  if (!object) throw Error("only objects can be framed");
  const Bounds3 box = object->bounds();
  if (box.empty() || object->unbounded()) throw Error("this object has no bounds that could be framed");
  Pose pose = pose_of(*camera);
  const Axes axes = axes_of(pose);
  const Point3 c = box.centre();
  const DoublePoint3 centre = job.rendering_origin() + DoubleVector3{double(c.x), double(c.y), double(c.z)};
  double angle = 0.7;
  if (const Member* fov = camera->class_info().find("fov"))
    if (const Value value = fov->get(*camera, *fov); value.as<Number>()) angle = value.as<Number>()->value;
  const double radius = std::max(double(length(box.diagonal())) / 2, 1e-6);
  pose.to = centre;
  pose.from = centre - (1.1 * radius / std::sin(std::min(angle, 3.0) / 2)) * axes.forward;
  return placed(call, camera, pose);
}

const RegisterRequests registered{
    {"view", false, view},   {"orbit", false, orbit}, {"pan", false, pan},
    {"dolly", false, dolly}, {"fly", false, fly},     {"frame", false, frame},
};

}  // namespace

}  // namespace etendue::studio
