#pragma once
// A scene of Assimp's as glTF.

#include <assimp/scene.h>

#include "glb.h"

namespace etendue::assimp_helper {

/// The whole scene of a file with this ending (small letters, without a dot). `unit` is that of its lengths [m], where the
/// library does not tell it; 0: it does.
void convert(const aiScene&, Glb&, const std::string& ending, double unit);

/// The materials; their places are those in the scene. See materials.cpp.
void convert_materials(const aiScene&, Glb&, const std::string& ending);

/// Lights and cameras, as children of the nodes that have their names. `node_of` gives the place of a node by its name, or
/// SIZE_MAX; `unit` is the length of the file's unit [m].
void convert_lights(const aiScene&, Glb&, size_t (*node_of)(const void* names, const char* name), const void* names,
                    double unit);

Json matrix_json(const aiMatrix4x4&);

}  // namespace etendue::assimp_helper
