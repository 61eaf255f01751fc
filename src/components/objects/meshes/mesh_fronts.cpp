#include "mesh_fronts.h"

#include <utility>

#include "geometry/closed_surface.h"

namespace etendue {

bool turn_to_normals(MeshData& mesh) {
  if (mesh.normals.empty()) return false;
  bool any = false;
  for (auto& t : mesh.triangles) {
    const Vector3 face = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    float along = 0;
    for (const std::uint32_t v : t) along += dot(face, Vector3(mesh.normals[v]));
    if (!(along < 0)) continue;
    std::swap(t[1], t[2]);
    any = true;
  }
  return any;
}

void turn_round(MeshData& mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  for (Normal3& n : mesh.normals) n = Normal3(-Vector3(n));
}

bool inside_out(const MeshData& mesh) { return inside_out(TriangleView{mesh.positions, mesh.triangles}); }

}  // namespace etendue
