// MaterialXImporter: the materials of a MaterialX document, each on a ball. Their classes are declared by the document as a
// plugin (src/osl/scene/materialx_files.cpp), so that they can be used, edited and saved as classes of a shader's file are.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "etendue/emission_shader.h"
#include "etendue/importer.h"
#include "etendue/object_map.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "materialx/materialx_document.h"

namespace etendue {
namespace {

/// A ball of triangles, as displacement needs it, with the surface coordinates of a Sphere: u around z, v upwards.
void set_ball(Component& mesh, Location at) {
  constexpr int around = 96, up = 48;
  std::vector<double> positions, normals, uvs, triangles;
  for (int j = 0; j <= up; ++j)
    for (int i = 0; i <= around; ++i) {
      const double u = double(i) / around, v = double(j) / up;
      const double phi = 2 * std::numbers::pi * u, theta = std::numbers::pi * (1 - v);
      const double n[3] = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
      positions.insert(positions.end(), n, n + 3);
      normals.insert(normals.end(), n, n + 3);
      uvs.insert(uvs.end(), {u, v});
      if (i == around || j == up) continue;
      const int first = j * (around + 1) + i, above = first + around + 1;
      if (j > 0) triangles.insert(triangles.end(), {double(first), double(first + 1), double(above + 1)});
      if (j < up - 1) triangles.insert(triangles.end(), {double(first), double(above + 1), double(above)});
    }
  set_member(mesh, "positions", Numbers{positions, 3, Dimension::none}, at);
  set_member(mesh, "normals", Numbers{normals, 3, Dimension::none}, at);
  set_member(mesh, "uvs", Numbers{uvs, 2, Dimension::none}, at);
  set_member(mesh, "triangles", Numbers{triangles, 3, Dimension::none}, at);
}

class MaterialXImporter final : public Importer {
 public:
  static void describe(Description<MaterialXImporter>& d) {
    d.summary(
        "MaterialX documents (.mtlx), read by the Python package materialx, which must be installed (pip install materialx; "
        "ETENDUE_PYTHON names the Python that has it): each material on a ball. -D material= chooses one by its name. The "
        "materials' classes: plugin \"file.mtlx\".",
        "Academy Software Foundation, MaterialX 1.39");
  }
  std::vector<std::string> extensions() const override { return {"mtlx"}; }

  Ref<Component> import(Importing& importing) const override {
    const Location at = importing.at();
    const std::string wanted = importing.parameter("material").value_or("");
    std::shared_ptr<const MaterialXDocument> document;
    try {
      document = read_materialx(importing.path(), importing.options().allowed_folders);
      for (const std::string& note : document->notes) importing.inexact(note, at);
      document->told = true;
      Registry::instance().load_plugin(importing.path());
    } catch (const Error& error) {
      throw Error(error.what(), at);
    }
    std::vector<const MaterialXMaterial*> shown;
    std::string names;
    for (const MaterialXMaterial& m : document->materials) {
      names += (names.empty() ? "" : ", ") + m.name;
      if (!wanted.empty() && m.name != wanted) continue;
      const ClassInfo* info = Registry::instance().find(m.class_name);
      if (m.problem.empty() && info && info->declared)
        shown.push_back(&m);
      else
        importing.inexact(fmt::format("{} is left out{}", m.name, m.problem.empty() ? "" : ": " + m.problem), at);
    }
    if (shown.empty())
      throw Error(wanted.empty() ? "none of its materials can be read"
                                 : fmt::format("it has no material '{}' that can be read; it has {}", wanted, names),
                  at);
    return stage(importing, shown);
  }

 private:
  /// Balls of radius 1 m in rows on a floor, lit from both sides.
  static Ref<Component> stage(Importing& importing, const std::vector<const MaterialXMaterial*>& shown) {
    const int count = int(shown.size()), columns = int(std::ceil(std::sqrt(double(count)))),
              rows = (count + columns - 1) / columns;
    constexpr double distance = 2.5;
    const double size = count == 1 ? 1 : 0.7 * (1 + 0.5 * distance * (columns - 1));  // of the stage, over that for one ball
    const std::string text = fmt::format(
        R"(Job {{
    renderer: PathTracer {{ max_depth: 24, samples: 64 }}
    camera: PerspectiveCamera {{ from: [{0} * 0.4, {0} * -6.0, {0} * {1}] m, to: [0, 0, {2}] m, up: [0, 0, 1], fov: 27 deg }}
    image: ImageBuffer {{ width: 480, height: 480, filter: GaussianFilter {{}} }}
    outputs: [PngOutput {{}}]
    scene: BvhScene {{ objects: [
        Rectangle {{ corner: [-20 * {0}, -20 * {0}, 0] m, edge_u: [40 * {0}, 0, 0] m, edge_v: [0, 40 * {0}, 0] m
            shader: Lambertian {{ color: CheckerMap {{ first: 0.35, second: 0.55, repeat: [80 * {0}, 80 * {0}, 1] }} }} }}
        Rectangle {{ corner: [-4.5 * {0}, -2.5 * {0}, 3.5 * {0}] m, edge_u: [{0}, -1.6 * {0}, 0.4 * {0}] m
            edge_v: [0.6 * {0}, 0.6 * {0}, 1.8 * {0}] m, emission: DiffuseEmission {{ radiance: 8, sides: both }} }}
        Rectangle {{ corner: [3.4 * {0}, {0}, 2 * {0}] m, edge_u: [0.4 * {0}, {0}, 0] m, edge_v: [-0.4 * {0}, 0, 1.6 * {0}] m
            emission: DiffuseEmission {{ radiance: 5, sides: both }} }}
        Environment {{ emission: DiffuseEmission {{ radiance: 0.25 }} }}
    ] }}
}})",
        size, count > 1 ? 4.2 : 1.9, count > 1 ? 0.5 : 0.9);
    const Ref<Component> job = parse_component(text, "the stage of MaterialXImporter");
    const auto scene = ref_cast<Scene>(*get(*job, "scene").as<Ref<Component>>());
    for (int i = 0; i < count; ++i) {
      const int row = i / columns, in_row = std::min(columns, count - row * columns);
      const double x = distance * (i % columns - 0.5 * (in_row - 1)), y = distance * (0.5 * (rows - 1) - row);
      scene->objects.push_back(ball(importing, *shown[size_t(i)], x, y));
    }
    return job;
  }

  static Ref<SceneObject> ball(Importing& importing, const MaterialXMaterial& m, double x, double y) {
    const Location at = importing.at();
    Ref<Component> object;
    if (m.displacement.empty()) {
      object = importing.make("Sphere", at);
    } else {
      object = importing.make("DisplacedMesh", at);
      const Ref<Component> mesh = importing.make("TriangleMesh", at);
      set_ball(*mesh, at);
      set_member(*object, "surface", mesh, at);
      set_member(*object, "edge_length", 0.03, at);
      const auto map = [&](const char* output) {
        const Ref<Component> made = importing.make(m.displacement_class(), at, m.name + "_displacement");
        if (*output) set_member(*made, "output", output, at);
        return made;
      };
      if (m.vector) {
        set_member(*object, "offset", Value::List{Value(map("x")), Value(map("y")), Value(map("z"))}, at);
        set_member(*object, "offset_space", "tangent", at);
      } else {
        set_member(*object, "displacement", map(""), at);
      }
    }
    set_member(*object, "transform", Transform::translate({x, y, 1}), at);
    const Ref<Component> made = importing.make(m.class_name, at, m.name);
    if (ref_cast<Shader>(made)) {
      set_member(*object, "shader", made, at);
      const bool has_light = m.emits && Registry::instance().find(m.class_name + "Emission");
      if (has_light) set_member(*object, "emission", importing.make(m.class_name + "Emission", at, m.name + "_emission"), at);
    } else {
      set_member(*object, "emission", made, at);
    }
    return ref_cast<SceneObject>(object);
  }
};

const Register<MaterialXImporter> registered;

}  // namespace
}  // namespace etendue
