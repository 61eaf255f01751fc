#pragma once
// Tessellates the limit surface of a subdivision cage into triangles.

#include <array>

#include "components/objects/meshes/polygon_mesh.h"

namespace etendue {

struct SubdivisionRules {
  // In the order in which descriptions name them.
  enum class Scheme : std::uint8_t { catmull_clark, loop, bilinear };
  enum class Boundary : std::uint8_t { none, edges, edges_and_corners };
  enum class UvBoundary : std::uint8_t { smooth, corners, corners_and_junctions, corners_and_darts, boundaries, linear };

  Scheme scheme = Scheme::catmull_clark;
  Boundary boundary = Boundary::edges_and_corners;
  UvBoundary uv_boundary = UvBoundary::corners_and_junctions;
  static constexpr float sharpest = 10;  ///< from this sharpness on an edge or a corner is infinitely sharp
  std::vector<std::array<std::uint32_t, 2>> creases;
  std::vector<float> crease_sharpness;  ///< for each crease
  std::vector<std::uint32_t> corners;
  std::vector<float> corner_sharpness;  ///< for each corner
};

/// The fineness of the triangles: each edge of the cage is divided into 2^levels pieces or, if a tolerance or a length is
/// given, into as few pieces as these require, at most 2^levels.
struct Fineness {
  int levels = 4;
  float tolerance = 0;    ///< largest distance of triangles from the limit surface [m]; 0: any
  float edge_length = 0;  ///< largest length of a triangle's edge [m]; 0: any
};

struct LimitMesh {
  MeshData mesh;
  size_t coarse = 0;         ///< edges and faces of the cage that would need more pieces than 2^levels
  size_t without_limit = 0;  ///< faces of the cage that have no limit surface
};

/// Tessellates the limit surface of a cage that `tidy` has cleaned; vertices have positions and normals of the limit. Triangles
/// on both sides of a cage edge share its vertices; where normals or surface coordinates differ along the edge (creases,
/// seams), the vertices are copies at exactly the same position. Throws Error.
LimitMesh limit_mesh(const PolygonMesh&, const SubdivisionRules&, const Fineness&);

}  // namespace etendue
