// Writes objects with their emission, and instances.

#include <algorithm>
#include <array>

#include "components/exporters/triangles/facets.h"
#include "transport/unprepared.h"
#include "writer.h"

namespace etendue::pbrt_export {

namespace {

constexpr size_t most_inline = 64;  ///< vertices of a mesh that is written inline

/// The twelve triangles of a box; each face has its own corners and texture coordinates.
ExportedMesh box_of(const Component& box) {
  const std::vector<double> centre = numbers_of(box, "centre"), size = numbers_of(box, "size");
  ExportedMesh mesh;
  for (size_t axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto base = std::uint32_t(mesh.positions.size() / 3);
      for (int corner = 0; corner < 4; ++corner) {
        const int a = corner % 2, b = corner / 2;
        std::array<double, 3> p{};
        p[axis] = side * 0.5;
        p[u] = a - 0.5;
        p[v] = b - 0.5;
        for (size_t c = 0; c < 3; ++c) mesh.positions.push_back(centre[c] + size[c] * p[c]);
        mesh.uvs.insert(mesh.uvs.end(), {float(a), float(b)});
      }
      const std::array<std::uint32_t, 6> front{0, 1, 3, 0, 3, 2}, back{0, 3, 1, 0, 2, 3};
      for (const std::uint32_t i : side > 0 ? front : back) mesh.indices.push_back(base + i);
    }
  return mesh;
}

}  // namespace

std::string Writer::mesh(const ExportedMesh& m, const std::string& more) {
  if (m.positions.size() / 3 > most_inline)
    return fmt::format("Shape \"plymesh\" \"string filename\" \"{}\"{}\n", exporting.write_beside("mesh", "ply", ply_of(m)),
                       more);
  std::string text = "Shape \"trianglemesh\" \"integer indices\" " + list(m.indices) + " \"point3 P\" " + list(m.positions);
  if (!m.normals.empty()) text += " \"normal N\" " + list(m.normals);
  if (!m.uvs.empty()) text += " \"point2 uv\" " + list(m.uvs);
  return text + more + "\n";
}

std::string Writer::shape(const SceneObject& object, const std::string& more, bool& placed) {
  const std::string name = object.class_info().name;
  placed = false;
  const auto moved = [&](const char* member) {
    const std::vector<double> c = numbers_of(object, member);
    return c[0] == 0 && c[1] == 0 && c[2] == 0 ? std::string() : fmt::format("Translate {} {} {}\n", c[0], c[1], c[2]);
  };
  if (name == "Sphere")
    return moved("centre") + fmt::format("Shape \"sphere\" \"float radius\" {}{}\n", number_of(object, "radius"), more);
  if (name == "Ellipsoid") {
    const std::vector<double> r = numbers_of(object, "radii");
    return moved("centre") + fmt::format("Scale {} {} {}\nShape \"sphere\"{}\n", r[0], r[1], r[2], more);
  }
  // pbrt's disks have polar texture coordinates.
  const bool disc = name == "Disc" || name == "Annulus";
  const bool as_disc = disc && (word_of(object, "coordinates") == "around" || !textured(part_of(object, "shader").get()));
  if (name == "Disc" && !as_disc) {
    bool curved = false;
    exporting.inexact("a Disc with these surface coordinates becomes triangles", &object);
    return mesh(*facets_of(object, curved), more);
  }
  if (name == "Disc") return fmt::format("Shape \"disk\" \"float radius\" {}{}\n", number_of(object, "radius"), more);
  if (name == "Annulus" && !as_disc) exporting.inexact("surface coordinates of an Annulus go around in pbrt", &object);
  if (name == "Annulus")
    return fmt::format("Shape \"disk\" \"float radius\" {} \"float innerradius\" {} \"float phimax\" {}{}\n",
                       number_of(object, "radius"), number_of(object, "inner_radius"), number_of(object, "sweep"), more);
  if (name == "Cylinder") {
    const double half = number_of(object, "height") / 2, radius = number_of(object, "radius"),
                 sweep = number_of(object, "sweep");
    std::string text =
        fmt::format("Shape \"cylinder\" \"float radius\" {} \"float zmin\" {} \"float zmax\" {} \"float phimax\" {}{}\n",
                    radius, -half, half, sweep, more);
    if (truth_of(object, "caps")) {
      const std::string cap = fmt::format("Shape \"disk\" \"float radius\" {} \"float phimax\" {}", radius, sweep);
      text += fmt::format("{0} \"float height\" {1}{2}\nReverseOrientation {0} \"float height\" {3}{2}\nReverseOrientation\n",
                          cap, half, more, -half);
    }
    return text;
  }
  if (name == "Rectangle") {
    const std::vector<double> c = numbers_of(object, "corner"), u = numbers_of(object, "edge_u"),
                              v = numbers_of(object, "edge_v");
    std::vector<double> points;
    for (const double b : {0.0, 1.0})
      for (const double a : {0.0, 1.0})
        for (size_t i = 0; i < 3; ++i) points.push_back(c[i] + a * u[i] + b * v[i]);
    return fmt::format("Shape \"bilinearmesh\" \"point3 P\" {}{}\n", list(points), more);
  }
  if (name == "Box") return mesh(box_of(object), more);
  if (const auto triangles = mesh_of(object, placed)) {
    if (name == "TriangleMesh" && !numbers_of(object, "times").empty())
      exporting.inexact("a mesh that changes its shape is still in pbrt", &object);
    return mesh(*triangles, more);
  }
  exporting.inexact(fmt::format("pbrt has no shape like {}: it is left out", name), &object);
  return {};
}

std::string Writer::emission_of(const SceneObject& object, bool& reversed) {
  const Ref<Component> emission = part_of(object, "emission");
  reversed = false;
  if (!emission) return {};
  const std::string name = emission->class_info().name, sides = word_of(*emission, "sides");
  if (name != "DiffuseEmission") {
    exporting.inexact(fmt::format("light that leaves a surface by {} leaves it alike in all directions in pbrt", name),
                      emission.get());
    if (!emission->class_info().find("radiance")) return {};
  }
  reversed = sides == "back";
  std::string text = "AreaLightSource \"diffuse\"";
  const Ref<Component> map = part_of(*emission, "radiance");
  if (map && map->class_info().name == "ImageMap")
    text += fmt::format(" \"string filename\" \"{}\"", exporting.copy_beside(word_of(with_file(*map, false), "file")));
  else
    text += light_of(*emission, "L", object);
  if (sides == "both") text += " \"bool twosided\" true";
  return text + "\n";
}

void Writer::object(const SceneObject& object, bool instanced) {
  const std::string name = object.class_info().name;
  if (name == "Instance") {
    if (instanced)
      exporting.inexact("instances within instances are left out", &object);
    else
      instance(object);
    return;
  }
  if (const auto* nested = dynamic_cast<const Scene*>(&object)) {
    out_ += "AttributeBegin\n" + transform_of(object.transform, "ConcatTransform");
    objects(*nested, instanced);
    out_ += "AttributeEnd\n";
    return;
  }
  if (object.surrounds() || light_source(object)) return;
  const Ref<Component> shader = part_of(object, "shader"), interior = part_of(object, "interior");
  const Surface surface = surface_of(shader.get());
  bool reversed = false, placed = false;
  std::string emission = emission_of(object, reversed);
  if (instanced && !emission.empty()) {
    exporting.inexact("what is instanced does not emit in pbrt", &object);
    emission.clear();
  }
  std::string medium;
  if (interior)
    if (const std::string inside = medium_of(*interior); !inside.empty())
      medium = fmt::format("MediumInterface \"{}\" \"{}\"\n", inside, around_);
  // An object without an interior has the same medium on both sides, so that light reflected by a wall continues in it.
  if (medium.empty() && !around_.empty() && !enterable_once_prepared(object))
    medium = fmt::format("MediumInterface \"{0}\" \"{0}\"\n", around_);
  if (word_of(object, "sides") != "both") exporting.inexact("surfaces scatter light on both sides in pbrt", &object);
  const std::string directive = shape(object, surface.alpha, placed);
  if (directive.empty()) return;
  out_ += "AttributeBegin\n";
  if (!placed) out_ += transform_of(object.transform, "ConcatTransform");
  out_ += emission + medium + fmt::format("NamedMaterial \"{}\"\n", surface.material);
  if (reversed) out_ += "ReverseOrientation\n";
  out_ += directive + "AttributeEnd\n";
}

void Writer::instance(const Component& object) {
  const Ref<Component> scene = part_of(object, "scene");
  if (!scene) return;
  if (part_of(object, "shader")) exporting.inexact("the shader of an instance is left out", &object);
  std::string& name = instanced_[scene.get()];
  if (name.empty()) {
    name = exporting.name_for(*scene);
    // Instanced objects are defined under the identity transform.
    out_ += fmt::format("AttributeBegin\nIdentity\nObjectBegin \"{}\"\n", name);
    const auto& inner = dynamic_cast<const Scene&>(*scene);
    objects(inner, true);
    out_ += "ObjectEnd\nAttributeEnd\n";
  }
  const auto& placed = dynamic_cast<const SceneObject&>(object);
  out_ += "AttributeBegin\n" + transform_of(placed.transform, "ConcatTransform") +
          fmt::format("ObjectInstance \"{}\"\nAttributeEnd\n", name);
}

void Writer::objects(const Scene& scene, bool instanced) {
  for (const Ref<SceneObject>& o : scene.objects) object(*o, instanced);
}

}  // namespace etendue::pbrt_export
