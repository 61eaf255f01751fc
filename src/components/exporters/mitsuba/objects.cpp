// Writes shapes and instances.

#include <cmath>

#include "transport/unprepared.h"
#include "writer.h"

namespace etendue::mitsuba_export {

void Writer::objects(Node parent, const Scene& scene, const Transform& outer) {
  for (const Ref<SceneObject>& o : scene.objects) object(parent, *o, outer);
}

void Writer::object(Node parent, const SceneObject& o, const Transform& outer) {
  const Transform placed = outer * still(transform_of(o, "transform"), o);
  const std::string& type = class_of(o);
  if (o.surrounds()) return;  // see view.cpp, `camera`
  if (const auto* inner = dynamic_cast<const Scene*>(&o)) return objects(parent, *inner, placed);
  if (type == "Instance") return instance(parent, o, placed);
  if (light_source(o, placed)) return;
  Uv uv = Uv::as_is;
  Node n = type == "TriangleMesh" ? mesh(parent, o, placed, outer) : shape(parent, o, placed, uv);
  if (!n) n = mesh(parent, o, placed, outer);
  if (!n) {
    exporting.inexact(fmt::format("Mitsuba has no shape like {}: it is left out", type), &o);
    return;
  }
  const Ref<Component> shader = part_of(o, "shader"), light = part_of(o, "emission"), inside = part_of(o, "interior");
  const std::string sides = word_of(o, "sides");
  surface(n, shader.get(), sides == "both", uv);
  if (word_of(o, "shading_normals") != "clipped" && holds(shader.get(), {"BumpShader", "NormalMapShader"}))
    exporting.inexact(
        "light that tilted normals would send through the surface is lost in Mitsuba, as by 'shading_normals' clipped", &o);
  if (light) emission(n, o, *light, uv);
  if (inside) medium(n, *inside, "interior", placed);
  if (around_ && enterable_once_prepared(o)) medium(n, *around_, "exterior", {});
  if (sides == "back") truth(n, "flip_normals", true);
  // Mitsuba's emitters emit from the front, which `flip_normals` turns into the back.
  if (const std::string shines = light ? word_of(*light, "sides") : ""; light && shines != (sides == "back" ? "back" : "front"))
    exporting.inexact(fmt::format("light from {} comes from the {} alone in Mitsuba",
                                  shines == "both" ? "both sides" : "the " + shines, sides == "back" ? "back" : "front"),
                      &o);
}

Node Writer::shape(Node parent, const SceneObject& o, const Transform& placed, Uv& uv) {
  const std::string& type = class_of(o);
  Node n;
  if (type == "Sphere") {
    uv = Uv::from_top;
    n = plugin(parent, "shape", "sphere");
    const std::vector<double> c = numbers_of(o, "centre");
    value(n, "point", "center", fmt::format("{} {} {}", c[0], c[1], c[2]));
    number(n, "radius", number_of(o, "radius"));
    transform(n, "to_world", placed);
  } else if (type == "Rectangle") {
    // Maps [-1, 1] x [-1, 1] to the corner and the edges.
    n = plugin(parent, "shape", "rectangle");
    const std::vector<double> p = numbers_of(o, "corner"), u = numbers_of(o, "edge_u"), v = numbers_of(o, "edge_v");
    const DoubleVector3 across = cross(DoubleVector3{u[0], u[1], u[2]}, DoubleVector3{v[0], v[1], v[2]});
    const double l = length(across);
    if (!(l > 0)) return n;
    const Transform edges(Transform::DoubleMatrix{u[0] / 2, v[0] / 2, across.x / l, p[0] + (u[0] + v[0]) / 2,  //
                                                  u[1] / 2, v[1] / 2, across.y / l, p[1] + (u[1] + v[1]) / 2,  //
                                                  u[2] / 2, v[2] / 2, across.z / l, p[2] + (u[2] + v[2]) / 2});
    transform(n, "to_world", placed * edges);
  } else if (type == "Disc" && (word_of(o, "coordinates") == "polar" || !textured(part_of(o, "shader").get()))) {
    n = plugin(parent, "shape", "disk");
    const double r = number_of(o, "radius");
    transform(n, "to_world", placed * Transform::scale({r, r, 1}));
  } else if (type == "Cylinder" && !truth_of(o, "caps") && number_of(o, "sweep") == 360) {
    n = plugin(parent, "shape", "cylinder");
    number(n, "radius", number_of(o, "radius"));
    transform(
        n, "to_world",
        placed * Transform::translate({0, 0, -number_of(o, "height") / 2}) * Transform::scale({1, 1, number_of(o, "height")}));
  } else if (type == "Box") {
    if (textured(part_of(o, "shader").get()))
      exporting.inexact("the faces of a box have other coordinates for textures in Mitsuba", &o);
    n = plugin(parent, "shape", "cube");
    const std::vector<double> c = numbers_of(o, "centre"), s = numbers_of(o, "size");
    transform(n, "to_world",
              placed * Transform::translate({c[0], c[1], c[2]}) * Transform::scale({s[0] / 2, s[1] / 2, s[2] / 2}));
  }
  return n;
}

Node Writer::mesh(Node parent, const SceneObject& o, const Transform& placed, const Transform& outer) {
  const bool listed = class_of(o) == "TriangleMesh";
  std::string name = listed ? word_of(o, "file") : "";
  bool flat = listed && truth_of(o, "flat"), done = false;
  const std::optional<ExportedMesh> triangles = mesh_of(o, done);
  if (!triangles) return {};
  flat = flat || triangles->normals.empty();
  // A file that Mitsuba can read is used unchanged, including its other vertex and face attributes.
  name = name.ends_with(".ply") ? exporting.copy_beside(name) : exporting.write_beside("mesh", "ply", ply_of(*triangles));
  Node n = plugin(parent, "shape", "ply");
  text(n, "filename", name);
  if (flat) truth(n, "face_normals", true);
  transform(n, "to_world", done ? outer : placed);
  return n;
}

void Writer::emission(Node shape, const SceneObject& o, const Component& e, Uv uv) {
  Node n = plugin(shape, "emitter", "area");
  if (class_of(e) != "DiffuseEmission")
    exporting.inexact(fmt::format("Mitsuba has no area light like {}: the same light leaves in all directions", class_of(e)),
                      &e);
  light(n, "radiance", o, e, uv);
}

void Writer::light(Node n, const char* name, const SceneObject& o, const Component& e, Uv uv) {
  if (!e.class_info().find("radiance")) return;
  const double factor = strength_of(o, e);
  const bool amount = has_amount(e);
  const Ref<Component> m = part_of(e, "radiance");
  if (m && class_of(*m) == "ConstantMap") {
    const Color c = color_of(*m, "value");
    spectrum(n, name, amount ? scaled_spectrum(factor, c) : c, ColorUse::radiance);
    return;
  }
  if (amount)
    exporting.inexact("an amount of light is left out where a picture emits: it is as strong as its radiance says", &e);
  map(n, name, e, "radiance", ColorUse::radiance, uv);
}

void Writer::instance(Node parent, const Component& i, const Transform& placed) {
  const Ref<Component> scene = part_of(i, "scene");
  if (part_of(i, "shader")) exporting.inexact("an instance keeps the surfaces of what it is of", &i);
  std::string& id = groups_[scene.get()];
  if (id.empty()) {
    id = exporting.name_for(*scene);
    Node group = plugin(scene_, "shape", "shapegroup");
    group.append_attribute("id") = id.c_str();
    objects(group, *ref_cast<Scene>(scene), {});
  }
  Node n = plugin(parent, "shape", "instance");
  n.append_child("ref").append_attribute("id") = id.c_str();
  transform(n, "to_world", placed);
}

}  // namespace etendue::mitsuba_export
