#pragma once
// Triangles divided into smaller ones, and moved as a map says.

#include <memory>
#include <span>

#include "etendue/object_map.h"
#include "etendue/scene_object.h"
#include "mesh_data.h"

namespace etendue {

/// Triangles halved along their edges. Whether an edge is divided, and where, depends on its ends' places alone, so that
/// neighbours always agree, also across seams, where they have copies of the ends.
class DividedTriangles {
 public:
  explicit DividedTriangles(const TriangleView&);

  /// Halves every edge so many times, then those longer than `edge_length` (0: none) until there are none; 15 times at most
  /// in all. Returns false when that was not enough. Throws Error when there would be too many.
  bool divide(int levels, float edge_length);

  /// Forgets all but what `place` needs.
  void keep_places() {
    positions = {};
    triangles = {};
  }

  std::vector<Point3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  /// A triangle of the original and barycentric coordinates of its second and third corner.
  struct Place {
    std::uint32_t triangle;
    float u, v;
  };
  Place place(size_t triangle, float u, float v) const;
  Place corner(size_t triangle, size_t corner) const {
    return place(triangle, corner == 1 ? 1.0f : 0.0f, corner == 2 ? 1.0f : 0.0f);
  }

 private:
  // Halving 15 times leaves multiples of 2^-15, which these hold exactly.
  static constexpr int most_halvings = 15;
  struct Within {
    std::uint32_t triangle;
    std::array<std::array<std::uint16_t, 2>, 3> corners;  // barycentric coordinates times 2^15
  };
  bool halve(float longer_than);

  std::vector<Within> within_;  // for each triangle; empty while they are those of the original
  int halvings_ = 0;
};

/// How far points move, in the coordinates of what contains the surface; so are all places that maps see, lest the shape
/// change when the whole is moved.
struct Displacement {
  const SceneObject* surface = nullptr;
  const ObjectMap* height = nullptr;       ///< along the normal
  std::span<const Ref<ObjectMap>> offset;  ///< along three axes; or none
  bool along_tangents = false;             ///< these axes: the directions in which u and v grow and the normal, else x, y and z
  float scale = 1, midlevel = 0;           ///< a map's value m means scale * (m - midlevel) [m]
  float smooth_cosine = 0.75f;             ///< of the angle up to which normals of the surface that meet in a place are blended
};

/// Moves the corners of triangles of a surface: all that lie in one place alike, so that nothing gapes, along the mean of
/// the shading normals there, as the mean of what the map says of them. The result has normals of its own shape, and surface
/// coordinates when the surface has.
MeshData displace(const DividedTriangles&, const Displacement&);

}  // namespace etendue
