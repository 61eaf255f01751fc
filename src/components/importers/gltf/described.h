#pragma once
// Parts that glTF has no words for, in the private extensions of files that our own converters make (etendue_usd.py). They are
// not read in files of others.
//
// ETENDUE_part {"class": "Rectangle", "members": {…}, "rigid": true, "lamp": true} on a node: an object with the node's place
// (rigid: without its size). {"members": {…}} on a camera: members of the camera made of it.
// ETENDUE_surface on a material: {"base_color": {…}, "metalness": {…}, …}, what Surface has, with textures of any channel.
//
// A value is a number, a text, true or false, a list of numbers, or an object with one of
//   "class", "members"  a part              "accessor"  a list of numbers in the file's buffer
//   "angle"             [rad]               "image"     the file of an image
//   "rgb"               a linear sRGB colour
//   "color"             a map: {"value": [r, g, b], "offset": […], "texture": {…}}
//   "texture" of these  {"image", "wrap": [u, v], "scale", "shift", "angle", "transfer", "uv_set"}, v upwards

#include "materials.h"

namespace etendue::gltf {

/// A part as such an object describes it; `name` is its name.
Ref<Component> described_part(Importing&, const Document&, Materials&, const Json&, const std::string& name);
/// Sets what {"members": {…}} says.
void set_described_members(Importing&, const Document&, Materials&, const Json&, Component&);

}  // namespace etendue::gltf
