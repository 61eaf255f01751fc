#pragma once
// Converts an Assimp scene to glTF.

#include <assimp/scene.h>

#include "glb.h"

namespace etendue::assimp_helper {

/// Converts the whole scene of a file with this ending (lower case, without a dot). `unit` is the file's unit of length [m] if
/// Assimp does not report it; 0: it does.
void convert(const aiScene&, Glb&, const std::string& ending, double unit);

/// Converts the materials; indices are those in the scene. See materials.cpp.
void convert_materials(const aiScene&, Glb&, const std::string& ending);

/// Converts lights and cameras to children of the nodes with their names. `node_of` returns the index of a node by its name, or
/// SIZE_MAX; `unit` is the file's unit of length [m].
void convert_lights(const aiScene&, Glb&, size_t (*node_of)(const void* names, const char* name), const void* names,
                    double unit);

Json matrix_json(const aiMatrix4x4&);

}  // namespace etendue::assimp_helper
