// Mitsuba's analytic shapes, and the properties that all shapes share.

#include <fmt/format.h>

#include <algorithm>

#include "components/objects/meshes/mesh_data.h"
#include "converter.h"
#include "etendue/language/language.h"
#include "etendue/object_map.h"

namespace etendue::mitsuba {

namespace {

const std::vector<std::string> known_shapes = {
    "obj",     "ply",        "serialized",  "sphere",     "rectangle",    "disk",           "cylinder",
    "cube",    "shapegroup", "instance",    "hair",       "bsplinecurve", "linearcurve",    "merge",
    "sdfgrid", "ellipsoids", "heightfield", "deformable", "blender",      "ellipsoidsmesh", "batch"};

Numbers three(double x, double y, double z) { return {{x, y, z}, 1, Dimension::none}; }

bool is_mesh_file(const Element& e) { return e.type == "obj" || e.type == "ply" || e.type == "serialized"; }

bool mirrors(const TransformValue& t) { return t.transform.still().flips(); }

/// Mitsuba's refracting bsdfs test the side of a direction against the shading normal only, so that no light is lost, whatever
/// the geometric normal. A water sphere of 528 triangles under a sky three times as bright above as below is 0.03 % brighter
/// here than in Mitsuba with the mirrored shading-normal correction, and 0.5 % darker with clipped normals.
bool refracts_without_loss(const Component& shader) {
  const std::string& type = shader.class_info().name;
  if (type != "DisneyPrincipled") return type == "Dielectric" || type == "ThinDielectric" || type == "PassThrough";
  const Value clear = get(shader, "spec_trans");
  const Ref<Component>* const part = clear.as<Ref<Component>>();
  const Ref<ObjectMap> map = part ? ref_cast<ObjectMap>(*part) : nullptr;
  const Color number = map ? map->constant() : nullptr;
  return !number || number->at(550, ColorUse::coefficient) > 0;
}

}  // namespace

Ref<SceneObject> Converter::shape(const Element& e) {
  if (std::ranges::find(known_shapes, e.type) == known_shapes.end()) fail_unknown(e, known_shapes);
  const Reading reading(e);
  if (e.type == "instance") return ref_cast<SceneObject>(instance(e));
  if (e.type == "merge") {
    Ref<Component> all = group(e);
    set_transform(*all, e.transform(), e.location_of("to_world"));
    return ref_cast<SceneObject>(all);
  }
  if (Ref<Component> parts = parts_of_obj(e)) return ref_cast<SceneObject>(parts);
  Uv uv = Uv::as_is;
  Ref<Component> object = geometry(e, uv);
  if (!object) {
    inexact(e, fmt::format("shape '{}' is not known here: it is left out", e.type));
    e.dismiss();
    return nullptr;
  }
  const std::vector<const Element*> bsdfs = e.all("bsdf");
  if (bsdfs.size() > 1) importing_.inexact("a shape has one bsdf: the first counts", bsdfs[1]->at);
  set_surface(*object, e, uv, bsdfs.empty() ? nullptr : bsdfs.front());
  return ref_cast<SceneObject>(object);
}

Ref<Component> Converter::geometry(const Element& e, Uv& uv) {
  if (is_mesh_file(e)) return mesh(e, uv);
  if (e.type == "sphere") {
    uv = Uv::from_top;
    return sphere(e);
  }
  if (e.type == "rectangle") return rectangle(e);
  if (e.type == "cylinder") return cylinder(e);
  if (e.type == "cube") return cube(e);
  if (e.type == "sdfgrid") {  // grid values lie at the corners of cells that fill the unit cube; the surface ends there
    Ref<Component> grid = make("SignedDistanceGrid", e);
    set_member(*grid, "file", file(e), e.location_of("filename"));
    set_member(*grid, "low", three(0, 0, 0), e.at);
    set_member(*grid, "high", three(1, 1, 1), e.at);
    set_member(*grid, "capped", false, e.at);
    const std::string normals = e.string("normals", "smooth");
    if (normals != "smooth" && normals != "analytic")
      throw Error(fmt::format("'normals' is smooth or analytic, not '{}'", normals), e.location_of("normals"));
    set_member(*grid, "smooth", normals == "smooth", e.location_of("normals"));
    set_transform(*grid, e.transform(), e.location_of("to_world"));
    if (textured(e))
      inexact(
          e,
          "an sdfgrid has no coordinates for textures in Mitsuba, which shows one place of them; here they lie on the faces "
          "of its box");
    return grid;
  }
  if (e.type == "hair" || e.type == "bsplinecurve" || e.type == "linearcurve") return curves(e);
  if (e.type != "disk") return nullptr;
  Ref<Component> disc = make("Disc", e);
  set_transform(*disc, e.transform(), e.location_of("to_world"));
  if (textured(e)) {
    if (disc->class_info().find("coordinates"))
      set_member(*disc, "coordinates", "polar", e.at);
    else
      inexact(e, "a disk's coordinates for textures are along x and y, not around it");
  }
  return disc;
}

Ref<Component> Converter::sphere(const Element& e) {
  Ref<Component> sphere = make("Sphere", e);
  const DoubleVector3 centre = e.vector("center", {0, 0, 0});
  if (e.has("center")) set_member(*sphere, "centre", three(centre.x, centre.y, centre.z), e.location_of("center"));
  if (e.has("radius")) set_member(*sphere, "radius", e.number("radius", 1), e.location_of("radius"));
  set_transform(*sphere, e.transform(), e.location_of("to_world"));
  return sphere;
}

Ref<Component> Converter::rectangle(const Element& e) {
  Ref<Component> rectangle = make("Rectangle", e);
  set_member(*rectangle, "corner", three(-1, -1, 0), e.at);
  set_member(*rectangle, "edge_u", three(2, 0, 0), e.at);
  set_member(*rectangle, "edge_v", three(0, 2, 0), e.at);
  set_transform(*rectangle, e.transform(), e.location_of("to_world"));
  return rectangle;
}

Ref<Component> Converter::cylinder(const Element& e) {
  const DoubleVector3 from = e.vector("p0", {0, 0, 0}), to = e.vector("p1", {0, 0, 1});
  const double radius = e.number("radius", 1);
  const DoubleVector3 way{to.x - from.x, to.y - from.y, to.z - from.z};
  const double height = length(way);
  if (!(height > 0)) throw Error("the ends of the cylinder, p0 and p1, are the same", e.at);
  if (!(radius > 0)) throw Error("the radius of a cylinder must be more than 0", e.location_of("radius"));
  const auto [s, t, n] = frame_about(way);  // u begins at this direction
  const Transform frame(Transform::DoubleMatrix{s.x, t.x, n.x, from.x, s.y, t.y, n.y, from.y, s.z, t.z, n.z, from.z});
  Ref<Component> cylinder = make("Cylinder", e);
  set_member(*cylinder, "radius", radius, e.at);
  set_member(*cylinder, "height", height, e.at);
  set_member(*cylinder, "caps", false, e.at);
  TransformValue placed = e.transform();
  placed.transform = placed.transform * AnimatedTransform(frame * Transform::translate({0, 0, height / 2}));
  set_transform(*cylinder, placed, e.location_of("to_world"));
  return cylinder;
}

Ref<Component> Converter::cube(const Element& e) {
  if (!textured(e)) {
    Ref<Component> box = make("Box", e);
    set_member(*box, "size", three(2, 2, 2), e.at);
    set_transform(*box, e.transform(), e.location_of("to_world"));
    return box;
  }
  // A Box has other texture coordinates than Mitsuba's cube.
  Ref<Component> mesh = make("TriangleMesh", e);
  static constexpr int corners[6][4] = {{4, 5, 1, 0}, {6, 2, 3, 7}, {4, 6, 7, 5}, {5, 7, 3, 1}, {1, 3, 2, 0}, {6, 4, 0, 2}};
  Numbers positions{{}, 3, Dimension::none}, uvs{{}, 2, Dimension::none}, triangles{{}, 1, Dimension::none};
  for (int face = 0; face < 6; ++face) {
    for (const int corner : corners[face])
      for (const int bit : {4, 2, 1}) positions.values.push_back(corner & bit ? 1 : -1);
    for (const double x : {0., 1., 1., 1., 1., 0., 0., 0.}) uvs.values.push_back(x);
    for (const int i : {0, 1, 2, 3, 0, 2}) triangles.values.push_back(4 * face + i);
  }
  set_member(*mesh, "positions", positions, e.at);
  set_member(*mesh, "uvs", uvs, e.at);
  set_member(*mesh, "triangles", triangles, e.at);
  set_transform(*mesh, e.transform(), e.location_of("to_world"));
  return mesh;
}

bool Converter::textured(const Element& e) {
  if (const auto [known, is_new] = textured_.emplace(&e, false); !is_new) return known->second;
  for (const Property& p : e.properties) {
    const auto* nested = std::get_if<Nested>(&p.value);
    if (!nested) continue;
    const Element& inner = *nested->element;
    if ((inner.tag == "texture" && inner.type != "mesh_attribute" && inner.type != "vertexcolors") || textured(inner))
      return textured_[&e] = true;
  }
  return false;
}

bool Converter::tilts(const Element& e) {
  if (const auto [known, is_new] = tilts_.emplace(&e, false); !is_new) return known->second;
  if (e.tag == "bsdf" && (e.type == "bumpmap" || e.type == "normalmap")) return tilts_[&e] = true;
  for (const Property& p : e.properties)
    if (const auto* nested = std::get_if<Nested>(&p.value); nested && nested->element->tag == "bsdf" && tilts(*nested->element))
      return tilts_[&e] = true;
  return false;
}

/// Whether Mitsuba determines a shape's front in world space, after a mirroring transform has reversed its triangles: for
/// spheres, and for meshes whose normals are those of their triangles. Other shapes transform their normals.
bool Converter::front_by_world(const Element& e) {
  if (e.type == "sphere") return true;
  if (!is_mesh_file(e)) return false;
  if (e.boolean("face_normals", false)) return true;
  const std::string part = e.type == "serialized" ? std::to_string(e.integer("shape_index", 0)) : std::string();
  try {
    return read_mesh(file(e).resolved(), part).normals.empty();
  } catch (const Error&) {  // reported when the mesh is read
    return false;
  }
}

// With reversed normals the back is the front: the shaders of a two-sided bsdf are exchanged, and the indices of a dielectric.
Ref<Component> Converter::turned_round(const Ref<Component>& shader, Location at) {
  const auto [known, added] = turned_.try_emplace(shader.get());
  Ref<Component>& made = known->second;
  if (!added) return made;
  made = shader;  // unchanged unless some part of it has a front
  const auto change = [&](const char* member, const Value& value) {
    if (made == shader) {
      made = copy(*shader);
      if (made->origin && !made->origin->name.empty()) made->origin->name += "_turned";
    }
    set(*made, member, value);
  };
  for (const Member& m : shader->class_info().members) {
    const Value value = get(*shader, m.name);
    const auto* part = value.as<Ref<Component>>();
    if (!part || !*part || !dynamic_cast<const Shader*>(part->get())) continue;
    if (const Ref<Component> inner = turned_round(*part, at); inner != *part) change(m.name.c_str(), Value(inner, at));
  }
  const auto exchange = [&](const char* a, const char* b) {
    const Value first = get(*made, a), second = get(*made, b);
    change(a, second);
    change(b, first);
  };
  if (shader->class_info().name == "TwoSidedShader") exchange("front", "back");
  if (shader->class_info().name == "Dielectric") exchange("ior", "exterior");
  return made;
}

void Converter::set_surface(Component& object, const Element& e, Uv uv, const Element* bsdf, const Ref<Component>& shader) {
  bool flipped = e.boolean("flip_normals", false);
  if (mirrors(e.transform()) && front_by_world(e)) flipped = !flipped;
  std::vector<const Element*> emitters = e.all("emitter");
  const Element* glow = nullptr;
  std::erase_if(emitters, [&](const Element* emitter) {
    const bool inside = emitter->type == "volumelight";
    if (inside) glow = emitter;
    return inside;
  });
  if (!e.all("subsurface").empty()) inexact(e, "subsurface scattering of Mitsuba 0.5 is left out: the bsdf alone counts");
  if (!e.all("sensor").empty()) inexact(e, "a sensor on a shape is left out");

  const Element *const interior = e.nested("interior"), *const exterior = e.nested("exterior");
  Surface looks;
  if (bsdf) {
    looks = surface(*bsdf, textured(*bsdf) ? uv : Uv::as_is);
  } else if (shader) {
    looks = {shader, true};
  } else if (e.old && emitters.empty() && (interior || exterior)) {
    looks = {make("PassThrough", e, ""), true};  // an index-matched boundary of a medium
  } else if (emitters.empty()) {
    looks = {make("Lambertian", e, ""), false};  // Mitsuba's default: a diffuse surface of reflectance 0.5
  }
  // A surface that only its front shows, or that emits, stays as it is: the room that it faces can be what is meant.
  const bool holds_medium = interior && interior != exterior && emitters.empty() && looks.both_sides;
  const bool has_front = !emitters.empty() || interior || exterior || !looks.both_sides ||
                         (looks.shader && turned_round(looks.shader, e.at) != looks.shader);
  if (is_mesh_file(e) && has_front) flipped = settle_fronts(object, e, flipped, holds_medium);
  if (flipped && looks.shader) looks.shader = turned_round(looks.shader, e.at);
  if (looks.shader) set_member(object, "shader", looks.shader, e.at);
  // Mitsuba discards light that an interpolated normal would send through the surface.
  const bool smooth = (is_mesh_file(e) && !e.boolean("face_normals", false)) ||
                      (e.type == "sdfgrid" && e.string("normals", "smooth") == "smooth");
  if (looks.shader && (tilts(e) || (smooth && !refracts_without_loss(*looks.shader))))
    set_member(object, "shading_normals", "clipped", e.at);
  const char* const front = flipped ? "back" : "front";
  if (looks.shader && !looks.both_sides) set_member(object, "sides", front, e.at);
  if (!emitters.empty()) {
    Ref<Component> emission = area_emission(*emitters.front(), uv);
    if (flipped) set_member(*emission, "sides", "back", e.at);
    set_member(object, "emission", emission, e.at);
  }
  if (interior)
    if (const Ref<Component> inside = medium(*interior, object, glow))
      set_member(object, "interior", inside, e.location_of("interior"));
  if (flipped && (interior || exterior))
    inexact(e,
            "the normals of this shape point inwards, where Mitsuba has its exterior: here the medium is inside all the same");
  if (glow && !interior) inexact(*glow, "a 'volumelight' shines inside a medium, and its shape has none: it is left out");
  sides_.push_back(
      {Ref<SceneObject>(dynamic_cast<SceneObject*>(&object)), interior, exterior, groups_read_ > 0, e.location_of("exterior")});
  e.ignore({"silhouette_sampling_weight"});
}

}  // namespace etendue::mitsuba
