#pragma once
// The medium that surrounds the camera in scenes of other programs.
//
// In pbrt and Mitsuba a surface states the media on its two sides, and the camera the medium it is in; a ray that hits nothing
// stays in its medium to infinity. Here media are interiors of bodies. So a medium around a camera becomes, in this order, the
// interior of a body of the file that encloses the camera, the interior of the bounding box of a density grid, or the interior
// of Surroundings.

#include "etendue/importer.h"
#include "etendue/scene_object.h"

namespace etendue {

struct AroundCamera {
  Ref<Component> medium;         ///< a VolumeShader
  std::string name;              ///< the medium's name in messages: "'fog'"
  std::string program;           ///< the program in messages: "pbrt"
  Location at;                   ///< location in the file
  DoublePoint3 camera;           ///< camera position, in world space
  std::optional<Transform> box;  ///< of a heterogeneous medium: from the unit cube, which holds the medium, to world space
  /// Objects that have the medium inside and something else outside.
  std::vector<Ref<SceneObject>> bodies;
};

/// The object to be added to the world. Null: an object of the world encloses the camera, or the medium cannot be expressed,
/// which adds a warning.
Ref<SceneObject> surroundings_for(Importing&, const AroundCamera&, const std::vector<Ref<SceneObject>>& world);

/// In pbrt and Mitsuba the surrounding medium continues inside a body whose surface names no media. If the body may transmit
/// light, its interior is set to the medium when the medium is everywhere; otherwise a warning is added.
void let_medium_go_on(Importing&, const AroundCamera&, SceneObject& body, bool everywhere, Location at);

}  // namespace etendue
