#pragma once
// PolygonMesh: polygons as read from a file or a list, not triangulated: the cage of a subdivision surface.

#include "mesh_data.h"

namespace etendue {

/// Faces of any number of corners with shared vertices. Surface coordinates are stored per corner, not per vertex
/// (face-varying): a seam is an edge along which they differ, and is not a boundary.
struct PolygonMesh {
  static constexpr std::uint32_t none = 0xffffffffu;

  std::vector<Point3> positions;
  DoublePoint3 centre;  ///< the point to which positions are relative, as in MeshData
  std::vector<std::uint32_t> face_sizes;
  std::vector<std::uint32_t> corners;  ///< the vertex of each face's corners, face after face
  std::vector<Point2> uvs;
  std::vector<std::uint32_t> uv_corners;  ///< index into uvs for each corner; empty if there are no uvs
  std::vector<VertexAttribute> attributes;
};

// Like read_ply and read_obj, but faces are not triangulated. Normals are not read: the limit surface has its own.
PolygonMesh read_ply_polygons(std::string_view file);
PolygonMesh read_obj_polygons(std::string_view file);
/// Like read_mesh.
PolygonMesh read_polygon_mesh(const std::string& path);

/// The mapping of vertices by `tidy`.
struct TidiedVertices {
  std::vector<std::uint32_t> now;  ///< new index of each vertex; PolygonMesh::none for a vertex without faces
};

/// Cleans a mesh. With `weld`, merges vertices at the same position (files split vertices along seams). Removes faces with
/// fewer than three corners, with a repeated corner or with a corner that is not finite, with a warning that names `whose`, and
/// removes vertices without faces. Throws Error if nothing is left.
TidiedVertices tidy(PolygonMesh&, bool weld, const std::string& whose);

}  // namespace etendue
