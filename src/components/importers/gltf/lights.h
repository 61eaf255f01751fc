#pragma once
// Lights and cameras of glTF files.

#include "document.h"
#include "etendue/core/transform.h"

namespace etendue::gltf {

/// The translation and rotation of a transform, without scale: cameras and lights have no size.
Transform without_stretch(const Transform&);

/// The luminaire for a light of KHR_lights_punctual.
Ref<Component> make_light(Importing&, const Document&, size_t light, const Transform&);

struct MadeCamera {
  Ref<Component> camera;
  double aspect = 0;  ///< width over height; 0: not stated
};
MadeCamera make_camera(Importing&, const Document&, size_t camera, const Transform&);

}  // namespace etendue::gltf
