// Shapes, lights without shapes, media, instances.

#include <algorithm>
#include <cmath>

#include "transport/unprepared.h"
#include "writer.h"

namespace etendue::mitsuba_export {

namespace {

Node plugin(Node parent, const char* tag, const char* type) {
  Node n = parent.append_child(tag);
  n.append_attribute("type") = type;
  return n;
}

}  // namespace

void Writer::objects(Node parent, const Scene& scene, const Transform& outer) {
  for (const Ref<SceneObject>& o : scene.objects) object(parent, *o, outer);
}

void Writer::object(Node parent, const SceneObject& o, const Transform& outer) {
  const Transform placed = outer * still(transform_of(o, "transform"), o);
  const std::string& type = class_of(o);
  if (o.surrounds()) return;  // see camera
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
  if (inside) medium(n, *inside, "interior");
  if (around_ && enterable_once_prepared(o)) medium(n, *around_, "exterior");
  if (sides == "back") truth(n, "flip_normals", true);
  // Its emitters shine from the front, which `flip_normals` makes the back.
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
    // From [-1, 1] x [-1, 1] to the corner and the edges.
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
  // A file that Mitsuba reads stays as it is, with whatever else it tells of vertices and faces.
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

/// The radiance of an EnvironmentEmission that is the same from everywhere, before its scale; null: it is not.
static Color constant_environment(const Component& emission) {
  const Ref<Component> map = part_of(emission, "radiance");
  return map ? constant_of(*map) : nullptr;
}

bool Writer::light_source(const SceneObject& o, const Transform& placed) {
  const std::string& type = class_of(o);
  if (type != "Point" && type != "Distant" && type != "Environment") return false;
  const Ref<Component> e = part_of(o, "emission");
  if (!e) return true;
  const std::string& kind = class_of(*e);
  const auto note_illuminance = [&] {
    if (number_of(*e, "illuminance") > 0)
      exporting.inexact("the illuminance of an environment is left out: it is as strong as its scale says", e.get());
  };
  if (type == "Point") {
    const std::vector<double> p = numbers_of(o, "position");
    if (kind == "SpotEmission" && !part_of(*e, "picture")) {
      Node n = plugin(scene_, "emitter", "spot");
      light(n, "intensity", o, *e, Uv::as_is);
      number(n, "cutoff_angle", number_of(*e, "outer_angle"));
      number(n, "beam_width", number_of(*e, "inner_angle"));
      const std::vector<double> a = numbers_of(*e, "axis");
      const DoubleVector3 up = std::abs(a[1]) < 0.9 ? DoubleVector3{0, 1, 0} : DoubleVector3{1, 0, 0};
      transform(n, "to_world", placed * Transform::look_at({p[0], p[1], p[2]}, {p[0] + a[0], p[1] + a[1], p[2] + a[2]}, up));
      if (word_of(*e, "edge") != "linear") exporting.inexact("the edge of a spot is linear in angle in Mitsuba", e.get());
      return true;
    }
    if (kind != "DiffuseEmission")
      exporting.inexact(fmt::format("{} shines alike in all directions in Mitsuba", kind), e.get());
    Node n = plugin(scene_, "emitter", "point");
    light(n, "intensity", o, *e, Uv::as_is);
    const DoublePoint3 at = placed(DoublePoint3{p[0], p[1], p[2]});
    value(n, "point", "position", fmt::format("{} {} {}", at.x, at.y, at.z));
  } else if (type == "Distant") {
    Node n = plugin(scene_, "emitter", "directional");
    light(n, "irradiance", o, *e, Uv::as_is);
    const std::vector<double> d = numbers_of(o, "direction");
    const DoublePoint3 from = placed(DoublePoint3{}), to = placed(DoublePoint3{d[0], d[1], d[2]});
    value(n, "vector", "direction", fmt::format("{} {} {}", to.x - from.x, to.y - from.y, to.z - from.z));
  } else if (kind == "EnvironmentEmission" && !word_of(*e, "file").empty()) {
    note_illuminance();
    Node n = plugin(scene_, "emitter", "envmap");
    text(n, "filename", exporting.copy_beside(word_of(*e, "file")));
    number(n, "scale", number_of(*e, "scale"));
    transform(n, "to_world", placed);
    if (word_of(*e, "rows") != "poles")
      exporting.inexact("the rows of an environment lie half a texel apart in Mitsuba", e.get());
  } else if (kind == "DiffuseEmission") {
    light(plugin(scene_, "emitter", "constant"), "radiance", o, *e, Uv::as_is);
  } else if (const Color c = kind == "EnvironmentEmission" ? constant_environment(*e) : nullptr) {
    note_illuminance();
    const double scale = number_of(*e, "scale");
    spectrum(plugin(scene_, "emitter", "constant"), "radiance", scale == 1 ? c : scaled_spectrum(scale, c), ColorUse::radiance);
  } else {
    exporting.inexact(fmt::format("Mitsuba has no environment like {}: it is left out", kind), e.get());
  }
  return true;
}

void Writer::medium(Node of, const Component& v, const char* name) {
  if (class_of(v) != "HomogeneousVolume") {
    exporting.inexact(fmt::format("a medium like {} is left out", class_of(v)), &v);
    return;
  }
  Node n = plugin(of, "medium", "homogeneous");
  n.append_attribute("name") = name;
  if (const Color extinction = color_of(v, "extinction")) {
    // Components of more than 1 are refused there.
    const auto rgb = written_rgb(extinction);
    const double largest = rgb ? std::max(1.0, *std::ranges::max_element(*rgb)) : 1;
    if (largest > 1) number(n, "scale", largest);
    spectrum(n, "sigma_t", largest > 1 ? scaled_spectrum(1 / largest, extinction) : extinction, ColorUse::coefficient);
    spectrum(n, "albedo", color_of(v, "albedo"), ColorUse::reflectance);
  } else {
    const Color a = color_of(v, "absorption"), s = color_of(v, "scattering");
    std::string total, albedo;
    bool scatters = false;
    for (int nm = 360; nm <= 830; nm += 5) {
      const double absorbed = double(a->at(float(nm), ColorUse::coefficient)),
                   scattered = double(s->at(float(nm), ColorUse::coefficient));
      const double sum = absorbed + scattered;
      scatters = scatters || scattered > 0;
      total += fmt::format("{}{}:{:.7g}", nm > 360 ? ", " : "", nm, sum);
      albedo += fmt::format("{}{}:{:.7g}", nm > 360 ? ", " : "", nm, sum > 0 ? scattered / sum : 0);
    }
    value(n, "spectrum", "sigma_t", total);
    value(n, "spectrum", "albedo", scatters ? albedo : "0");  // a table of nothing but zeros is refused there
  }
  if (const Ref<Component> phase = part_of(v, "phase")) {
    phase_function(n, *phase);
  } else {
    henyey_greenstein(n, number_of(v, "anisotropy"));
  }
}

void Writer::henyey_greenstein(Node parent, double g) {
  Node phase = plugin(parent, "phase", g == 0 ? "isotropic" : "hg");
  if (g != 0) number(phase, "g", g);
}

void Writer::phase_function(Node parent, const Component& p) {
  const std::string& kind = class_of(p);
  if (kind == "RayleighPhase") {
    if (number_of(p, "depolarization") > 0) exporting.inexact("particles that depolarize are round in Mitsuba", &p);
    plugin(parent, "phase", "rayleigh");
  } else if (kind == "BlendPhase") {
    Node blend = plugin(parent, "phase", "blendphase");
    number(blend, "weight", number_of(p, "amount"));
    for (const char* part : {"first", "second"}) phase_function(blend, *part_of(p, part));
  } else if (kind == "TabulatedPhase" && numbers_of(p, "cosines").empty()) {
    Node table = plugin(parent, "phase", "tabphase");
    std::string values;
    for (const double value : numbers_of(p, "values")) values += fmt::format("{}{}", values.empty() ? "" : ", ", value);
    text(table, "values", values);
  } else {
    if (kind != "HenyeyGreensteinPhase")
      exporting.inexact(fmt::format("{} becomes one lobe of the same mean cosine", kind), &p);
    henyey_greenstein(parent, mean_cosine_of(p));
  }
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
