#pragma once
// Meshes given inline.

#include <array>
#include <vector>

#include "reader.h"

namespace etendue::pbrt {

struct Mesh {
  std::vector<double> positions, normals, uvs, indices;
};

using Vertex = std::array<double, 3>;
inline Vertex difference(const std::vector<double>& p, size_t a, size_t b) {
  return {p[3 * a] - p[3 * b], p[3 * a + 1] - p[3 * b + 1], p[3 * a + 2] - p[3 * b + 2]};
}
/// The positions as they are stored, relative to their centre.
std::vector<Point3> points_of(const std::vector<double>& positions);

// mesh_fronts.cpp
/// Turns round the triangles whose vertex normals point to their back.
void face_normals(Mesh&);
/// Whether the inside of the shapes that follow has a medium of its own, so that a mesh that is inside out is turned round.
bool holds_medium(const State&);
/// Whether triangles form a closed surface and are clockwise as seen from outside.
bool inside_out(const std::vector<double>& positions, const std::vector<double>& indices);
void turn_faces(std::vector<double>& indices);
void turn_round(Mesh&);

/// Reversed if the state's orientation is reversed.
Shape object_of(Reader&, Mesh&&, Location at);

}  // namespace etendue::pbrt
