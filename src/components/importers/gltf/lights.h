#pragma once
// Lights and cameras of glTF files.

#include "document.h"
#include "etendue/core/transform.h"

namespace etendue::gltf {

/// What of a transform only moves and turns: cameras and lights have no size.
Transform without_stretch(const Transform&);

/// A luminaire of KHR_lights_punctual.
Ref<Component> make_light(Importing&, const Document&, size_t light, const Transform&);

struct MadeCamera {
  Ref<Component> camera;
  double aspect = 0;  ///< width over height; 0: of no matter
};
MadeCamera make_camera(Importing&, const Document&, size_t camera, const Transform&);

}  // namespace etendue::gltf
