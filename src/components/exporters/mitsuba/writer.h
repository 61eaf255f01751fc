#pragma once
// Writes a job as an XML file of Mitsuba 3.

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

/// Whether v of an object's texture coordinates is 1 - v of Mitsuba's shape.
enum class Uv : std::uint8_t { as_is, from_top };

/// The meaning of an image's texels.
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

  // maps.cpp: properties that are a colour or a texture.
  void map(Node, const char* name, const Component& of, const char* member, ColorUse, Uv);
  void texture(Node, const char* name, const Component& map, ColorUse, const Transform& coordinates, Uv);
  /// A number; for a texture warns and returns 0.5.
  double scalar(const Component& of, const char* member);
  void scalar_map(Node, const char* name, const Component& of, const char* member, Uv);
  void normals(Node, const char* name, const Component& image, Uv);
  /// The ImageMap, or a replacement whose file Mitsuba reads as this program reads the original.
  Ref<Component> readable(const Component& image);

  // shaders.cpp
  void surface(Node shape, const Component* shader, bool both_sides, Uv);
  /// Writes a bump or normal map and returns its node, into which the bsdf that it modifies is written.
  Node tilted(Node parent, const Component& shader, Uv);
  /// `both_sides`: Mitsuba's one-sided bsdfs are made two-sided, inside of those that transmit light.
  void bsdf(Node parent, const Component& shader, bool both_sides, Uv);
  void dielectric(Node, const Component&, Uv);
  void conductor(Node, const Component&, Uv);
  void roughness(Node, const Component&, Uv);

  // objects.cpp
  void objects(Node parent, const Scene&, const Transform& outer);
  void object(Node parent, const SceneObject&, const Transform& outer);
  /// The shape's node; empty: Mitsuba has no such shape.
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
  /// Writes the interior of a shape with this transform to world space.
  void medium(Node of, const Component& volume, const char* name, const Transform& placed);
  void grid_medium(Node of, const Component& volume, const char* name, const Transform& placed);
  /// Returns whether Mitsuba has such a medium.
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
  Ref<Component> around_;                                                // the medium that surrounds the scene
  Texels read_as_ = Texels::colors;                                      // of the texture being written
  std::map<std::pair<const Component*, Texels>, Ref<Component>> baked_;  // by image or product of images, as numbers or colours
  std::set<const Component*> readable_;                                  // images that were written for Mitsuba
  std::vector<Ref<Component>> made_;                                     // images of shaders that name a file instead of a map
  std::map<const Component*, std::string> groups_;
  std::map<std::tuple<const Component*, bool, Uv>, std::string> bsdfs_;
};

}  // namespace etendue::mitsuba_export
