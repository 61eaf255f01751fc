#pragma once
// Writes a job as a file of pbrt-v4.

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>

#include "components/exporters/members.h"
#include "components/exporters/triangles/exported_mesh.h"
#include "etendue/describe/color.h"
#include "etendue/exporter.h"
#include "etendue/render/job.h"

namespace etendue::pbrt_export {

/// A shader in pbrt: a material, and a parameter of the shape that has it.
struct Surface {
  std::string material;  ///< name; that of pbrt's null material is "interface"
  std::string alpha;     ///< parameter of the shape
};

class Writer {
 public:
  Writer(const Job& j, Exporting& e) : job(j), exporting(e) {}
  std::string write();

 private:
  // values.cpp: parameters, each with a leading blank.
  std::string spectrum(const char* name, const Color&, ColorUse) const;
  /// A light's spectrum, with the scale that undoes v4's normalization.
  std::string light(const char* name, const Color&) const;
  /// The light from an emission's radiance; empty, with a warning: it is not constant.
  std::string light_of(const Component& emission, const char* name, const SceneObject& object);
  /// The factor by which a requested amount of light multiplies the radiance; 1, with a warning, if it cannot be computed.
  double amount_of(const Component& emission, const SpectralFunction& radiance, const SceneObject& object);

  // maps.cpp: a parameter; textures that it refers to are written first.
  std::string color_map(const char* name, const Component& part, const char* member, ColorUse = ColorUse::reflectance);
  std::string number_map(const char* name, const Component& part, const char* member);
  std::string texture(const Component& map, bool numbers);
  std::string value_or_texture(const char* name, const Ref<Component>& map, bool numbers, ColorUse);
  std::string image(const Component& map, const std::string& more, bool numbers);
  /// The ImageMap, or one with a file that is written beside the scene instead of one given by its numbers.
  const Component& with_file(const Component& image, bool numbers);

  // shaders.cpp
  Surface surface_of(const Component* shader);
  std::string material_of(const Component& shader);
  std::string parameters_of(const Component& shader, std::string& type);
  std::string roughness_of(const Component& shader, const std::string& prefix);
  std::string index_of(const Component& shader, const std::string& name);
  std::string metal_of(const Component& shader, const std::string& prefix);
  std::string layered(const Component& shader, std::string& type);
  std::string medium_of(const Component& medium);

  // objects.cpp
  void objects(const Scene&, bool instanced);
  void object(const SceneObject&, bool instanced);
  /// The shape's directive; empty, with a warning: pbrt has no such shape.
  std::string shape(const SceneObject&, const std::string& more, bool& placed);
  std::string mesh(const ExportedMesh&, const std::string& more);
  std::string emission_of(const SceneObject&, bool& reversed);
  void instance(const Component&);

  // lights.cpp
  bool light_source(const SceneObject&);
  std::string point_light(const SceneObject&, const Component& emission);
  std::string environment(const SceneObject&, const Component& emission);

  // pbrt_exporter.cpp
  void surroundings();

  // view.cpp
  void view();
  void camera();
  void film();
  void integrator();

  std::string transform_of(const AnimatedTransform&, const char* directive);

  const Job& job;
  Exporting& exporting;
  std::string out_;
  std::string around_;                                ///< the medium that surrounds the scene; empty: none
  std::map<const Component*, Ref<Component>> baked_;  // by images read as numbers, and products of images and colours
  std::map<std::pair<const Component*, bool>, Ref<Component>>
      listed_;  // files of images given by numbers; as numbers or colours
  std::map<const Component*, std::string> materials_, textures_, media_, instanced_;
};

/// "[ 1 2 3 ]"
std::string list(const auto& numbers) {
  std::string text = "[";
  for (const auto n : numbers) text += fmt::format(" {}", n);
  return text + " ]";
}
std::string matrix(const Transform&);

}  // namespace etendue::pbrt_export
