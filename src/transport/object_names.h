#pragma once
// ObjectNames: what the objects and shaders of a scene are called, and their numbers, for mattes and layers of identifiers.

#include <map>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "etendue/transport/object_groups.h"

namespace etendue {

/// What has no name in the file is called by its class and a number in the order of the file, "Sphere 3".
class ObjectNames {
 public:
  /// For a prepared scene.
  explicit ObjectNames(const Scene&);

  /// Nested scenes that are no objects of a list are left out.
  NamePath path(const Hit&) const;
  /// The name of an object's shader; "none" without a shader.
  std::string material(const SceneObject&) const;

  /// 1 + the index in the scene's list of the object that is hit, or of what contains it; 0: unknown.
  int object_number(const Hit&) const;
  /// 1 + the index of an object's shader in the order in which the scene's objects have them; 0: it has none.
  int material_number(const SceneObject&) const;

  /// All names of objects, also of those in nested scenes, each once.
  std::vector<std::string> all() const;

 private:
  void add(const Scene&, bool outermost);
  void add(const Component&);
  std::string name_of(const SceneObject&) const;
  using Place = std::tuple<std::string, int, int>;  // in the description
  static Place place_of(const Component&);

  std::unordered_map<const Component*, std::string> names_;
  std::map<std::string, int> counts_;  // by class
  std::map<Place, std::string> written_;
  std::unordered_map<const Component*, int> objects_, materials_;
};

}  // namespace etendue
