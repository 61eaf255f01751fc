#include "exported_mesh.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "components/exporters/asked_members.h"
#include "components/exporters/members.h"
#include "components/objects/meshes/mesh_data.h"
#include "etendue/mesh_facts.h"

namespace etendue {
namespace {

std::vector<double> list(const Component& part, const char* member) {
  const Value value = value_of(part, member);
  const Numbers* numbers = value.as<Numbers>();
  return numbers ? numbers->values : std::vector<double>();
}

/// Computes normals as TriangleMesh does, for a mesh without any.
void find_normals(ExportedMesh& mesh) {
  MeshData data;
  for (const std::uint32_t i : mesh.indices)
    if (3 * size_t(i) + 2 >= mesh.positions.size()) return;  // indices have not been checked before
  for (size_t i = 0; i + 2 < mesh.positions.size(); i += 3)
    data.positions.push_back({float(mesh.positions[i]), float(mesh.positions[i + 1]), float(mesh.positions[i + 2])});
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    data.triangles.push_back({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
  smooth_normals(data);
  for (const Normal3& n : data.normals) mesh.normals.insert(mesh.normals.end(), {n.x, n.y, n.z});
}

ExportedMesh from_file(const std::string& path, const std::string& part, bool smooth) {
  MeshData data = read_mesh(path, part);
  if (smooth && data.normals.empty() && !data.faceted) smooth_normals(data);
  ExportedMesh mesh;
  for (const Point3& p : data.positions)
    mesh.positions.insert(mesh.positions.end(),
                          {double(p.x) + data.centre.x, double(p.y) + data.centre.y, double(p.z) + data.centre.z});
  for (const Normal3& n : data.normals) mesh.normals.insert(mesh.normals.end(), {n.x, n.y, n.z});
  for (const Point2& t : data.uvs) mesh.uvs.insert(mesh.uvs.end(), {t.x, t.y});
  for (const auto& t : data.triangles) mesh.indices.insert(mesh.indices.end(), {t[0], t[1], t[2]});
  return mesh;
}

ExportedMesh from_members(const SceneObject& object) {
  const Value file = value_of(object, "file");
  const FilePath* path = file.as<FilePath>();
  ExportedMesh mesh;
  if (path && !path->empty()) {
    const Value part = value_of(object, "part"), smooth = value_of(object, "smooth");
    mesh = from_file(path->resolved(), *part.as<std::string>(), *smooth.as<bool>());
  } else {
    mesh.positions = list(object, "positions");
    for (const double i : list(object, "triangles")) mesh.indices.push_back(std::uint32_t(i));
    for (const double n : list(object, "normals")) mesh.normals.push_back(float(n));
    for (const double t : list(object, "uvs")) mesh.uvs.push_back(float(t));
    if (mesh.normals.empty() && truth_of(object, "smooth")) find_normals(mesh);
  }
  const Value flat = value_of(object, "flat");
  if (const bool* is = flat.as<bool>(); is && *is) mesh.normals.clear();
  return mesh;
}

/// A mesh in which each triangle has its own corners, with the attributes of the surface at each corner.
ExportedMesh from_surface(const SceneObject& object, const TriangleView& view) {
  ExportedMesh mesh;
  bool smooth = false;
  for (size_t t = 0; t < view.triangles.size(); ++t)
    for (size_t corner = 0; corner < 3; ++corner) {
      Hit hit;
      hit.object = &object;
      hit.primitive = std::uint32_t(t);
      hit.u = corner == 1 ? 1.0f : 0.0f;
      hit.v = corner == 2 ? 1.0f : 0.0f;
      const Point3 at = view.positions[view.triangles[t][corner]];
      SurfacePoint p;
      object.surface_point(Ray(at, Vector3{0, 0, 1}), hit, p);
      mesh.indices.push_back(std::uint32_t(mesh.positions.size() / 3));
      mesh.positions.insert(mesh.positions.end(), {at.x, at.y, at.z});
      mesh.normals.insert(mesh.normals.end(), {p.shading_normal.x, p.shading_normal.y, p.shading_normal.z});
      mesh.uvs.insert(mesh.uvs.end(), {p.uv.x, p.uv.y});
      smooth = smooth || dot(p.shading_normal, p.normal) < 0.99999f;
    }
  if (!smooth) mesh.normals.clear();
  return mesh;
}

void append(std::string& to, const auto& value) {
  static_assert(std::endian::native == std::endian::little);
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  to.append(bytes, sizeof value);
}

}  // namespace

std::optional<ExportedMesh> mesh_of(const SceneObject& object, bool& placed) {
  placed = false;
  if (object.class_info().name == "TriangleMesh") return from_members(object);
  if (object.transform.animated()) return std::nullopt;
  // A copy, as preparing may change an object's members.
  AskedMembers::note_shape(object);
  const Ref<SceneObject> twin = ref_cast<SceneObject>(copy(object));
  prepare_tree(*twin);
  const std::optional<TriangleView> view = still_triangles(*twin);
  if (!view) return std::nullopt;
  placed = true;
  return from_surface(*twin, *view);
}

std::string ply_of(const ExportedMesh& mesh) {
  const size_t vertices = mesh.positions.size() / 3, triangles = mesh.indices.size() / 3;
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n",
      vertices);
  if (!mesh.normals.empty()) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.uvs.empty()) text += "property float u\nproperty float v\n";
  text += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", triangles);
  for (size_t i = 0; i < vertices; ++i) {
    for (size_t c = 0; c < 3; ++c) append(text, float(mesh.positions[3 * i + c]));
    for (size_t c = 0; c < 3 && !mesh.normals.empty(); ++c) append(text, mesh.normals[3 * i + c]);
    for (size_t c = 0; c < 2 && !mesh.uvs.empty(); ++c) append(text, mesh.uvs[2 * i + c]);
  }
  for (size_t t = 0; t < triangles; ++t) {
    text += char(3);
    for (size_t c = 0; c < 3; ++c) append(text, std::int32_t(mesh.indices[3 * t + c]));
  }
  return text;
}

}  // namespace etendue
