#pragma once
// Meshes that are written out.

#include <vector>

#include "reader.h"

namespace etendue::pbrt {

struct Mesh {
  std::vector<double> positions, normals, uvs, indices;
};

/// Turned over when the state says so.
Shape object_of(Reader&, Mesh&&, Location at);

}  // namespace etendue::pbrt
