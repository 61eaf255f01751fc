#pragma once
// A job on its way into an XML file of Mitsuba 3.

#include <fmt/format.h>

#include <map>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "components/exporters/amounts.h"
#include "components/exporters/members.h"
#include "components/exporters/triangles/exported_mesh.h"
#include "components/volumes/volume_grid.h"
#include "etendue/describe/color.h"
#include "etendue/exporter.h"
#include "etendue/render/job.h"

namespace etendue::mitsuba_export {

using Node = pugi::xml_node;

inline Node plugin(Node parent, const char* tag, const char* type) {
  Node n = parent.append_child(tag);
  n.append_attribute("type") = type;
  return n;
}

/// Whether v of an object's surface coordinates is 1 - that of Mitsuba's shape.
enum class Uv : std::uint8_t { as_is, from_top };

/// What the texels of an image stand for.
enum class Texels : std::uint8_t { colors, numbers, normals };

class Writer {
 public:
  Writer(const Job& j, Exporting& e) : job(j), exporting(e) {}
  std::string write();

 private:
  // values.cpp
  void value(Node, const char* tag, const char* name, const std::string& text);
  void number(Node n, const char* name, double x) { value(n, "float", name, fmt::format("{}", x)); }
  void integer(Node n, const char* name, long x) { value(n, "integer", name, fmt::format("{}", x)); }
  void text(Node n, const char* name, const std::string& t) { value(n, "string", name, t); }
  void truth(Node n, const char* name, bool is) { value(n, "boolean", name, is ? "true" : "false"); }
  void spectrum(Node, const char* name, const Color&, ColorUse);
  void transform(Node, const char* name, const Transform&);
  Transform still(const AnimatedTransform&, const Component& of);

  // maps.cpp: a property that is a colour or a texture.
  void map(Node, const char* name, const Component& of, const char* member, ColorUse, Uv);
  void texture(Node, const char* name, const Component& map, ColorUse, const Transform& coordinates, Uv);
  /// A number; of what is a texture it is noted, and 0.5.
  double scalar(const Component& of, const char* member);
  void scalar_map(Node, const char* name, const Component& of, const char* member, Uv);
  void normals(Node, const char* name, const Component& image, Uv);
  /// The ImageMap, or one in its place whose file Mitsuba reads as it is read here.
  Ref<Component> readable(const Component& image);

  // shaders.cpp
  void surface(Node shape, const Component* shader, bool both_sides, Uv);
  /// `both_sides`: what Mitsuba has on the front alone is made two-sided, inside of what lets light through.
  /// A bump or normal map as a node, into which what is tilted is written.
  Node tilted(Node parent, const Component& shader, Uv);
  void bsdf(Node parent, const Component& shader, bool both_sides, Uv);
  void dielectric(Node, const Component&, Uv);
  void conductor(Node, const Component&, Uv);
  void roughness(Node, const Component&, Uv);

  // objects.cpp
  void objects(Node parent, const Scene&, const Transform& outer);
  void object(Node parent, const SceneObject&, const Transform& outer);
  /// The shape's node; none: Mitsuba has no such shape.
  Node shape(Node parent, const SceneObject&, const Transform& placed, Uv&);
  Node mesh(Node parent, const SceneObject&, const Transform& placed, const Transform& outer);
  void instance(Node parent, const Component& instance, const Transform& placed);
  void emission(Node shape, const SceneObject&, const Component& emission, Uv);
  void light(Node, const char* name, const SceneObject&, const Component& emission, Uv);
  // lamps.cpp
  bool light_source(const SceneObject&, const Transform& placed);
  void point(const SceneObject&, const Component& emission, const Transform& placed);
  void spot(const SceneObject&, const Component& emission, const Transform& placed);
  void projector(const SceneObject&, const Component& emission, const Transform& placed);

  // media.cpp
  /// What fills a shape that stands in the world so.
  void medium(Node of, const Component& volume, const char* name, const Transform& placed);
  void grid_medium(Node of, const Component& volume, const char* name, const Transform& placed);
  /// Whether Mitsuba has such a medium.
  bool map_medium(Node of, const Component& volume, const char* name, const Transform& placed);
  void grid(Node medium, const char* name, const VolumeGrid&, bool by_file, const Component& volume, const Transform& placed);
  void phase_of(Node medium, const Component& volume);
  void henyey_greenstein(Node parent, double g);
  void phase_function(Node parent, const Component&);

  // view.cpp
  void view();
  void camera(Node sensor);
  void film(Node sensor);
  void integrator();
  void hide_emitters(Node integrator);

  const Job& job;
  Exporting& exporting;
  pugi::xml_document document_;
  Node scene_;
  Ref<Component> around_;            // the medium around everything
  Texels read_as_ = Texels::colors;  // of the texture that is written
  std::map<std::pair<const Component*, Texels>, Ref<Component>>
      baked_;                            // by images and products of them, as numbers or colours
  std::set<const Component*> readable_;  // images that were written for Mitsuba
  std::vector<Ref<Component>> made_;     // images for shaders that hold one of their own
  std::map<const Component*, std::string> groups_;
  std::map<std::tuple<const Component*, bool, Uv>, std::string> bsdfs_;
};

}  // namespace etendue::mitsuba_export
