#pragma once
// A job on its way into an XML file of Mitsuba 3.

#include <fmt/format.h>

#include <map>
#include <pugixml.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "components/exporters/amounts.h"
#include "components/exporters/members.h"
#include "components/exporters/triangles/exported_mesh.h"
#include "etendue/describe/color.h"
#include "etendue/exporter.h"
#include "etendue/render/job.h"

namespace etendue::mitsuba_export {

using Node = pugi::xml_node;

/// Whether v of an object's surface coordinates is 1 - that of Mitsuba's shape.
enum class Uv : std::uint8_t { as_is, from_top };

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

  // shaders.cpp
  void surface(Node shape, const Component* shader, bool both_sides, Uv);
  /// `both_sides`: what Mitsuba has on the front alone is made two-sided, inside of what lets light through.
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
  void emission(Node shape, const SceneObject&, const Component& emission, Uv);
  void light(Node, const char* name, const SceneObject&, const Component& emission, Uv);
  bool light_source(const SceneObject&, const Transform& placed);
  void medium(Node of, const Component& volume, const char* name);
  void henyey_greenstein(Node parent, double g);
  void phase_function(Node parent, const Component&);
  void instance(Node parent, const Component& instance, const Transform& placed);

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
  Ref<Component> around_;                             // the medium around everything
  bool number_ = false;                               // whether the texture that is written stands for a number
  std::map<const Component*, Ref<Component>> baked_;  // by products of images and colours
  std::map<const Component*, std::string> groups_;
  std::map<std::tuple<const Component*, bool, Uv>, std::string> bsdfs_;
};

}  // namespace etendue::mitsuba_export
