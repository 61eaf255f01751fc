#pragma once
// Meshes given inline.

#include <vector>

#include "reader.h"

namespace etendue::pbrt {

struct Mesh {
  std::vector<double> positions, normals, uvs, indices;
};

/// Reversed if the state's orientation is reversed.
Shape object_of(Reader&, Mesh&&, Location at);

}  // namespace etendue::pbrt
