#pragma once
// Components that glTF cannot express, in private extensions of files that our own converters write (etendue_usd.py). The
// extensions are ignored in other files.
//
// ETENDUE_part {"class": "Rectangle", "members": {…}, "rigid": true, "lamp": true} on a node: an object with the node's
// transform (rigid: without its scale). {"members": {…}} on a camera: members of the camera made from it.
// ETENDUE_surface on a material: {"base_color": {…}, "metalness": {…}, …}, the members of Surface, with textures of any
// channel.
//
// ETENDUE_materialx {"file": …, "name": …, "uv_set": …} on a material: it is the material of that name of a MaterialX document, or
// of the networks of a USD scene.
//
// A value is a number, a text, true or false, a list of numbers, or an object with one of
//   "class", "members"  a part              "accessor"  a list of numbers in the file's buffer
//   "angle"             [rad]               "image"     the file of an image
//   "rgb"               a linear sRGB colour
//   "color"             a map: {"value": [r, g, b], "offset": […], "texture": {…}}
//   "texture" of these  {"image", "wrap": [u, v], "scale", "shift", "angle", "transfer", "uv_set"}, v upwards

#include "materials.h"

namespace etendue::gltf {

/// The component that a JSON object of this form describes, with this name.
Ref<Component> described_part(Importing&, const Document&, Materials&, const Json&, const std::string& name);
/// Sets the members of {"members": {…}}.
void set_described_members(Importing&, const Document&, Materials&, const Json&, Component&);

}  // namespace etendue::gltf
