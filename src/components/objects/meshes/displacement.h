#pragma once
// Displacement mapping: subdivides triangles and displaces their vertices by maps.

#include <memory>
#include <span>

#include "etendue/mesh_facts.h"
#include "etendue/object_map.h"
#include "mesh_data.h"

namespace etendue {

/// Triangles subdivided by halving edges. Whether an edge is halved, and where, depends only on the positions of its ends, so
/// that neighbours always agree, also across seams, where the vertices are duplicated.
class DividedTriangles {
 public:
  explicit DividedTriangles(const TriangleView&);

  /// Halves every edge `levels` times, then repeatedly the edges longer than `edge_length` (0: none); at most 15 times in
  /// total. Returns false if longer edges remain. Throws Error if there would be too many triangles.
  bool divide(int levels, float edge_length);

  /// Frees all data except those that `place` needs.
  void keep_places() {
    positions = {};
    triangles = {};
  }

  std::vector<Point3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  /// A point on the original mesh: a triangle and the barycentric coordinates of its second and third corner.
  struct Place {
    std::uint32_t triangle;
    float u, v;
  };
  Place place(size_t triangle, float u, float v) const;
  Place corner(size_t triangle, size_t corner) const {
    return place(triangle, corner == 1 ? 1.0f : 0.0f, corner == 2 ? 1.0f : 0.0f);
  }

 private:
  // After 15 halvings coordinates are multiples of 2^-15, which 16-bit integers hold exactly.
  static constexpr int most_halvings = 15;
  struct Within {
    std::uint32_t triangle;
    std::array<std::array<std::uint16_t, 2>, 3> corners;  // barycentric coordinates times 2^15
  };
  bool halve(float longer_than);

  std::vector<Within> within_;  // for each triangle; empty as long as nothing was divided
  int halvings_ = 0;
};

/// Parameters of a displacement. It is applied in the coordinates of the space that contains the surface. The positions at
/// which maps are evaluated are in the same coordinates, so that the shape does not depend on the transform of the displaced
/// object.
struct Displacement {
  const SceneObject* surface = nullptr;
  const ObjectMap* height = nullptr;       ///< along the normal
  std::span<const Ref<ObjectMap>> offset;  ///< three maps, for offsets along three axes; or none
  bool along_tangents = false;             ///< whether these axes are the directions of u and v and the normal, instead of x, y
                                           ///< and z
  float scale = 1, midlevel = 0;           ///< a map's value m displaces by scale * (m - midlevel) [m]
  float smooth_cosine = 0.75f;             ///< cosine of the angle up to which normals of the surface at one position are
                                           ///< averaged
};

/// Displaces the vertices of a surface's triangles. All vertices at one position are displaced alike, so that there are no
/// cracks: along the mean of their shading normals, by the mean of their map values. The result has the normals of its
/// displaced shape, and surface coordinates if the surface has them.
MeshData displace(const DividedTriangles&, const Displacement&);

}  // namespace etendue
