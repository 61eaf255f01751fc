#pragma once
// The medium that a camera of another program is told to be in.
//
// In pbrt and in Mitsuba a surface says which media are on its two sides, and the camera in which one it is; where a ray goes
// through nothing it stays in the medium it began in, for ever. Here media are the inside of bodies. So a medium around a
// camera is the interior of a body that holds the camera, where the file has one, the box of its densities, if they are on a
// grid, and else Surroundings.

#include "etendue/importer.h"
#include "etendue/scene_object.h"

namespace etendue {

struct AroundCamera {
  Ref<Component> medium;  ///< a VolumeShader
  std::string name;       ///< of the medium, for messages: "'fog'"
  std::string program;    ///< whose file it is: "pbrt"
  Location at;            ///< where the file says so
  DoublePoint3 camera;    ///< in the world
  std::optional<Transform>
      box;  ///< of a medium that is not the same everywhere: from the unit cube, which holds it, to the world
  /// Objects whose inside it is, and beyond whose surface is something else.
  std::vector<Ref<SceneObject>> bodies;
};

/// What has to be added to the objects of the world; null: a body among them holds the camera, or it cannot be expressed, which
/// was told.
Ref<SceneObject> surroundings_for(Importing&, const AroundCamera&, const std::vector<Ref<SceneObject>>& world);

/// In those programs a surface that names no media lets the one around go on behind it. Where light may get into such a body,
/// it is given the medium as its interior, if that is everywhere; else it is told that there is none.
void let_medium_go_on(Importing&, const AroundCamera&, SceneObject& body, bool everywhere, Location at);

}  // namespace etendue
