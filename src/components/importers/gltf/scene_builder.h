#pragma once
// Builds the objects, lights and cameras of a glTF scene.

#include <map>
#include <set>

#include "etendue/render/job.h"
#include "glow.h"
#include "lights.h"
#include "materials.h"
#include "primitive.h"

namespace etendue::gltf {

class SceneBuilder {
 public:
  SceneBuilder(Importing&, const Document&);

  Ref<Scene> build();
  /// The camera to render with, if the scene has one; call after `build`.
  std::optional<MadeCamera> camera();
  /// Whether the scene has light sources; call after `build`. Weakly emissive surfaces do not count.
  bool has_lights() const { return has_lights_ || glow_.lights(); }

 private:
  struct Shared {
    Ref<Scene> scene;
    Glow::Areas shining;
  };
  size_t chosen(const char* parameter, const char* list, size_t otherwise);
  Moment moment();
  std::vector<size_t> roots();
  void count_uses(const std::vector<size_t>& order);
  void add_node(size_t node);
  void add_described(const Json&, const std::string& name, const Transform&);
  void add_mesh(size_t node, size_t mesh);
  std::vector<Transform> places_of(size_t node);
  std::vector<Ref<SceneObject>> primitives(size_t mesh, const PartName& whose);
  Ref<SceneObject> primitive(size_t mesh, const Json& primitive, PartName, const std::string& name);
  const Shared& shared(size_t mesh);
  void add(const Ref<SceneObject>&);
  Location at() const { return importing_.at(); }

  Importing& importing_;
  const Document& document_;
  Moment moment_;
  Pose pose_;
  std::optional<size_t> variant_;
  Materials materials_;
  Ref<Scene> scene_;
  std::set<size_t> hidden_;        // hidden nodes; their cameras are still used (KHR_node_visibility)
  std::map<size_t, size_t> uses_;  // number of nodes that use each mesh
  std::map<size_t, Shared> shared_;
  std::vector<std::pair<size_t, Transform>> cameras_;
  Glow glow_;
  bool own_file_ = false;  // written by Étendue
  double triangles_ = 0;
  bool has_lights_ = false;
};

}  // namespace etendue::gltf
