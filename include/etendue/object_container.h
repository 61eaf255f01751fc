#pragma once
// ObjectContainer: implemented, in addition to SceneObject, by objects that contain other objects, such as scenes and solids of
// constructive solid geometry. The Job finds the contained objects through it, to give them an origin for their coordinates
// (docs/decisions/020-rendering-space.md).

#include <vector>

#include "etendue/scene_object.h"

namespace etendue {

class ObjectContainer {
 public:
  /// The objects whose transforms are relative to this one's object space; some may be null.
  virtual std::vector<SceneObject*> placed_within() const = 0;

 protected:
  ~ObjectContainer() = default;
};

/// The objects that an object contains; empty if it is no container. An Instance does not contain its scene.
inline std::vector<SceneObject*> objects_within(const SceneObject& object) {
  const auto* container = dynamic_cast<const ObjectContainer*>(&object);
  return container ? container->placed_within() : std::vector<SceneObject*>{};
}

}  // namespace etendue
