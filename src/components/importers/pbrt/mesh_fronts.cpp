// The front of meshes given inline, and of those whose medium would lie outside.

#include <array>
#include <utility>

#include "geometry/closed_surface.h"
#include "geometry/inner_origin.h"
#include "meshes.h"

namespace etendue::pbrt {

namespace {

Vertex across(const Vertex& a, const Vertex& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

// pbrt's front is the side of the vertex normals; here it is the side from which a triangle is counter-clockwise.
void face_normals(Mesh& mesh) {
  const std::vector<double>& positions = mesh.positions;
  std::vector<double>& indices = mesh.indices;
  for (size_t t = 0; t + 2 < indices.size(); t += 3) {
    const size_t a = size_t(indices[t]), b = size_t(indices[t + 1]), c = size_t(indices[t + 2]);
    const Vertex face = across(difference(positions, b, a), difference(positions, c, a));
    double along = 0;
    for (const size_t v : {a, b, c})
      for (size_t i = 0; i < 3; ++i) along += face[i] * mesh.normals[3 * v + i];
    if (along < 0) std::swap(indices[t + 1], indices[t + 2]);
  }
}

std::vector<Point3> points_of(const std::vector<double>& p) {
  std::vector<DoublePoint3> positions;
  for (size_t i = 0; i + 2 < p.size(); i += 3) positions.push_back({p[i], p[i + 1], p[i + 2]});
  return relative_to(inner_origin_for(positions), positions);
}

// A surface that emits stays as it is: the room that it faces can be what is meant.
bool holds_medium(const State& state) { return !state.inside.empty() && state.inside != state.outside && !state.light; }

bool inside_out(const std::vector<double>& positions, const std::vector<double>& indices) {
  const std::vector<Point3> points = points_of(positions);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (size_t t = 0; t + 2 < indices.size(); t += 3)
    triangles.push_back({std::uint32_t(indices[t]), std::uint32_t(indices[t + 1]), std::uint32_t(indices[t + 2])});
  return etendue::inside_out(TriangleView{points, triangles});
}

void turn_faces(std::vector<double>& indices) {
  for (size_t t = 0; t + 2 < indices.size(); t += 3) std::swap(indices[t + 1], indices[t + 2]);
}

void turn_round(Mesh& mesh) {
  turn_faces(mesh.indices);
  for (double& n : mesh.normals) n = -n;
}

}  // namespace etendue::pbrt
