#pragma once
// Polygons as they come from a file or a list, before anything makes triangles of them: the cage of a subdivision surface.

#include "mesh_data.h"

namespace etendue {

/// Faces of any number of corners with shared vertices. Surface coordinates belong to corners, not to vertices: a seam is an
/// edge along which they differ, and no hole.
struct PolygonMesh {
  static constexpr std::uint32_t none = 0xffffffffu;

  std::vector<Point3> positions;
  DoublePoint3 centre;  ///< what they are counted from, as in MeshData
  std::vector<std::uint32_t> face_sizes;
  std::vector<std::uint32_t> corners;  ///< the vertex of each face's corners, face after face
  std::vector<Point2> uvs;
  std::vector<std::uint32_t> uv_corners;  ///< which of uvs a corner has; empty: there are none
  std::vector<VertexAttribute> attributes;
};

// As read_ply and read_obj, but faces stay what they are. Normals are left out: the surface has its own.
PolygonMesh read_ply_polygons(std::string_view file);
PolygonMesh read_obj_polygons(std::string_view file);
/// As read_mesh.
PolygonMesh read_polygon_mesh(const std::string& path);

/// What tidy did to the vertices.
struct TidiedVertices {
  std::vector<std::uint32_t> now;  ///< the vertex that each one became; PolygonMesh::none: no face has it
};

/// Makes one vertex of those in the same place when `weld` says so (files split them along seams), and leaves out faces that
/// have fewer than three corners, one corner twice or a corner that is not finite, with a warning that names `whose`; and
/// vertices that no face has. Throws Error when nothing is left.
TidiedVertices tidy(PolygonMesh&, bool weld, const std::string& whose);

}  // namespace etendue
