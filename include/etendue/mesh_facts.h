#pragma once
// MeshFacts: what a mesh answers besides SceneObject's functions: its triangles for accelerators, the attributes of its
// vertices for maps, and notes for warnings. A shape implements it in addition to SceneObject, and returns itself from
// SceneObject::mesh_facts. All functions are optional.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "etendue/scene_object.h"

namespace etendue {

/// Triangles in the coordinates of the containing scene, for accelerators that intersect them directly. Embree reads 16 bytes
/// at each position, so four more bytes after the last position must be readable.
struct TriangleView {
  std::span<const Point3> positions;
  std::span<const std::array<std::uint32_t, 3>> triangles;
};

/// The number of a surface attribute's name, constant while the program runs. Maps and objects look it up in `prepare`, so that
/// no names are compared while rendering.
int attribute_number(const std::string& name);

/// Notes about a mesh that are reported to the user, in addition to its members.
struct MeshNotes {
  bool without_uv = false;              ///< the mesh has no surface coordinates (uv), so each triangle has its own
  std::vector<std::string> attributes;  ///< names of the vertex attributes that AttributeMap can read
  std::vector<std::string> materials;   ///< names of materials in the mesh's file, which are not read
};

class MeshFacts {
 public:
  /// The triangles, if the object consists of triangles that do not move.
  virtual std::optional<TriangleView> triangles() const { return std::nullopt; }
  /// Stores an attribute's values at a point of the object, such as the vertex colour: at most four. `number` is the
  /// attribute_number of its name. Returns the count of values; 0: the object has no attribute of this name.
  virtual int attribute(int /*number*/, const SurfacePoint&, float* /*values*/) const { return 0; }
  virtual MeshNotes notes() const { return {}; }
  /// The number of boundary edges, which belong to one triangle only. Slow.
  virtual std::uint64_t open_edges() const { return 0; }

 protected:
  ~MeshFacts() = default;
};

/// The triangles of an object, if it consists of triangles that do not move.
inline std::optional<TriangleView> still_triangles(const SceneObject& object) {
  const MeshFacts* facts = object.mesh_facts();
  return facts ? facts->triangles() : std::nullopt;
}

/// The notes about an object; empty unless it is a mesh.
inline MeshNotes notes_of(const SceneObject& object) {
  const MeshFacts* facts = object.mesh_facts();
  return facts ? facts->notes() : MeshNotes{};
}

}  // namespace etendue
