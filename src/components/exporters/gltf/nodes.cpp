// Writes the nodes: objects, instances, lights, the camera.

#include <cmath>
#include <numbers>

#include "writer.h"

namespace etendue::gltf_export {

namespace {

constexpr size_t most_nodes = 1'000'000;  // instances are written out with all objects inside

Json matrix(const Transform& t) {
  const auto& m = t.exact();
  return {m[0], m[4], m[8], 0, m[1], m[5], m[9], 0, m[2], m[6], m[10], 0, m[3], m[7], m[11], 1};
}

/// A rotation from -z, the viewing direction of glTF's cameras and lights, to a direction.
Transform looking(const DoublePoint3& from, const DoubleVector3& direction) {
  const double l = length(direction);
  const DoubleVector3 d{direction.x / l, direction.y / l, direction.z / l};
  const DoubleVector3 up = std::abs(d.y) < 0.9 ? DoubleVector3{0, 1, 0} : DoubleVector3{1, 0, 0};
  return Transform::look_at(from, {from.x + d.x, from.y + d.y, from.z + d.z}, up) *
         Transform::rotate(std::numbers::pi, {0, 1, 0});
}

/// Whether a transform shears, that is, does not preserve right angles, which glTF does not allow.
bool sheared(const Transform& t) {
  const auto& m = t.exact();
  for (size_t a = 0; a < 3; ++a) {
    const size_t b = (a + 1) % 3;
    double dot = 0, first = 0, second = 0;
    for (size_t r = 0; r < 12; r += 4) {
      dot += m[r + a] * m[r + b];
      first += m[r + a] * m[r + a];
      second += m[r + b] * m[r + b];
    }
    if (std::abs(dot) > 1e-6 * std::sqrt(first * second)) return true;
  }
  return false;
}

}  // namespace

Transform Writer::still(const AnimatedTransform& t, const Component& of) {
  if (t.animated()) exporting.inexact("motion is left out: things stand where their first key has them", &of);
  const Transform placed = t.written(t.keys().front().time);
  if (sheared(placed)) exporting.inexact("a sheared transform stands as it is, though glTF asks for none", &of);
  return placed;
}

size_t Writer::node(Json n) {
  if (++made_nodes_ > most_nodes) throw Error(fmt::format("the scene has more than {} objects with all instances", most_nodes));
  Json& nodes = document_["nodes"];
  nodes.push_back(std::move(n));
  return nodes.size() - 1;
}

size_t Writer::group(const Transform& t, Json children) {
  Json n;
  if (!t.identity()) n["matrix"] = matrix(t);
  if (!children.empty()) n["children"] = std::move(children);
  if (n.is_null()) n = Json::object();
  return node(std::move(n));
}

Json Writer::nodes_of(const Scene& scene) {
  Json all = Json::array();
  for (const Ref<SceneObject>& o : scene.objects)
    if (const auto n = node_of(*o)) all.push_back(*n);
  return all;
}

std::optional<size_t> Writer::node_of(const SceneObject& o) {
  const std::string& type = class_of(o);
  if (const auto* inner = dynamic_cast<const Scene*>(&o)) return group(still(o.transform, o), nodes_of(*inner));
  if (type == "Instance") {
    if (part_of(o, "shader")) exporting.inexact("an instance keeps the surfaces of what it is of", &o);
    const Ref<Scene> scene = ref_cast<Scene>(part_of(o, "scene"));
    return scene ? std::optional(group(still(o.transform, o), nodes_of(*scene))) : std::nullopt;
  }
  bool is_light = false;
  const std::optional<size_t> light = light_node(o, is_light);
  if (is_light) return light;
  bool placed = false;
  const std::optional<size_t> m = mesh(o, placed);
  if (!m) {
    exporting.inexact(fmt::format("{} has no triangles: it is left out", type), &o);
    return std::nullopt;
  }
  Json n{{"mesh", *m}};
  const Transform t = placed ? Transform() : still(o.transform, o);
  if (!t.identity()) n["matrix"] = matrix(t);
  return node(std::move(n));
}

// KHR_lights_punctual, in the units that the importer uses: viewers show a luminance of Y = 1 as white.
std::optional<size_t> Writer::light_node(const SceneObject& o, bool& is_light) {
  const std::string& type = class_of(o);
  is_light = type == "Point" || type == "Distant" || type == "Environment";
  if (!is_light) return std::nullopt;
  const Ref<Component> e = part_of(o, "emission");
  if (type == "Environment") {
    if (e) exporting.inexact("an environment is left out: glTF has none", &o);
    return std::nullopt;
  }
  if (!e) return std::nullopt;
  const bool spot = is_spot(*e);
  if ((!spot && class_of(*e) != "DiffuseEmission") || (spot && part_of(*e, "picture")))
    exporting.inexact(fmt::format("{} shines alike in all directions that it shines in", class_of(*e)), e.get());
  const bool named = e->class_info().find("radiance") && !e->class_info().find("file");
  const Ref<Component> map = named ? part_of(*e, "radiance") : nullptr;
  Color c = map ? constant_of(*map) : nullptr;
  const double strength = c ? strength_of(o, *e) : 1;
  if (!c) c = mean_radiance(o, *e);
  if (!c) return std::nullopt;
  std::array<double, 3> rgb = rgb_of(c, ColorUse::radiance);
  double most = 0;
  for (double& x : rgb) most = std::max(most, x = std::max(0.0, x * strength));
  for (double& x : rgb) x = most > 0 ? x / most : 1;
  Json light{{"type", type == "Distant" ? "directional" : (spot ? "spot" : "point")}, {"color", rgb}, {"intensity", most}};
  DoubleVector3 way{0, 0, -1};
  if (spot) {
    constexpr double degree = std::numbers::pi / 180;
    light["spot"] = {{"innerConeAngle", number_of(*e, "inner_angle") * degree},
                     {"outerConeAngle", number_of(*e, "outer_angle") * degree}};
    const std::vector<double> axis = numbers_of(*e, "axis");
    way = {axis[0], axis[1], axis[2]};
    if (spot_edge(*e) != "square") exporting.inexact("the edge of a spot falls as t^2 in glTF", e.get());
  }
  DoublePoint3 from;
  const std::vector<double> at = numbers_of(o, type == "Distant" ? "direction" : "position");
  if (type == "Distant")
    way = {at[0], at[1], at[2]};
  else
    from = {at[0], at[1], at[2]};
  extend(document_, "KHR_lights_punctual", {});
  Json& lights = document_["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back(std::move(light));
  const Transform placed = still(o.transform, o) * looking(from, way);
  return node({{"matrix", matrix(placed)}, {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
}

size_t Writer::camera_node() {
  const Component& c = *job.camera;
  const std::string& type = class_of(c);
  const double width = number_of(*job.image, "width"), height = number_of(*job.image, "height");
  const bool parallel = type == "OrthographicCamera";
  // glTF requires a near plane for perspective cameras and both planes for orthographic ones: if nothing is clipped, they are
  // placed so near and so far that they cut nothing.
  const double near_clip = number_of(c, "near_clip"), far_clip = number_of(c, "far_clip");
  const double nearest = near_clip > 0 || parallel ? near_clip : (far_clip > 0 ? std::min(1e-4, far_clip / 2) : 1e-4);
  Json view;
  if (parallel) {
    const double half = number_of(c, "width") / 2;
    view = {{"xmag", half}, {"ymag", half * height / width}, {"znear", nearest}, {"zfar", std::max(1e7, 2 * nearest)}};
  } else {
    if (type != "PerspectiveCamera")
      exporting.inexact(fmt::format("glTF has no camera like {}: a pinhole stands for it", type), &c);
    const double angle = type == "PerspectiveCamera" ? field_of_view(c) * std::numbers::pi / 180 : 1;
    const std::string axis = word_of(c, "fov_axis");
    const bool across_width =
        axis == "width" || (axis == "smaller" && width <= height) || (axis == "larger" && width >= height);
    const double side = axis == "diagonal" ? std::hypot(width, height) : (across_width ? width : height);
    view = {{"yfov", 2 * std::atan(std::tan(angle / 2) * height / side)}, {"aspectRatio", width / height}, {"znear", nearest}};
    if (number_of(c, "lens_radius") > 0) exporting.inexact("everything is sharp in glTF: the lens is a pinhole", &c);
    const std::vector<double> middle = numbers_of(c, "principal_point");
    if (middle.size() == 2 && (middle[0] != 0 || middle[1] != 0))
      exporting.inexact("the axis of a camera meets the middle of the picture in glTF", &c);
  }
  if (far_clip > 0) view["zfar"] = far_clip;
  document_["cameras"].push_back(
      {{"type", parallel ? "orthographic" : "perspective"}, {parallel ? "orthographic" : "perspective", std::move(view)}});
  const std::vector<double> from = numbers_of(c, "from"), to = numbers_of(c, "to"), up = numbers_of(c, "up");
  Transform placed = still(transform_of(c, "transform"), c);
  if (from.size() == 3 && to.size() == 3 && up.size() == 3)
    placed = placed * Transform::look_at({from[0], from[1], from[2]}, {to[0], to[1], to[2]}, {up[0], up[1], up[2]});
  return node({{"camera", 0}, {"matrix", matrix(placed * Transform::rotate(std::numbers::pi, {0, 1, 0}))}});
}

}  // namespace etendue::gltf_export
