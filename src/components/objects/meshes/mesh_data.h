#pragma once
// MeshData: triangles as read from a file or a list, and the readers of mesh files.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// An attribute of vertices or of triangles, with `width` values for each.
struct VertexAttribute {
  std::string name;
  int width = 1;
  std::vector<float> values;
};

/// Triangles with shared vertices. Normals and uvs are per vertex, or absent.
struct MeshData {
  std::vector<Point3> positions;
  DoublePoint3 centre;  ///< the point in object space to which positions are relative
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Normal3> normals;  ///< zero for a vertex without normal
  std::vector<Point2> uvs;
  std::vector<VertexAttribute> attributes;        ///< "color" (linear sRGB) and any other vertex attributes of a file
  std::vector<VertexAttribute> face_attributes;   ///< per triangle: those of its face, named "face_" and a name
  std::vector<std::string> materials;             ///< names of the materials that the file uses, without duplicates; only the
                                                  ///< names are read
  bool faceted = false;                           ///< the file specifies face normals (flat shading)
  std::vector<std::uint32_t> triangle_materials;  ///< for each triangle, an index into `materials`; or empty
  std::string texture;                            ///< the texture image named in a PLY file
  std::vector<std::string> remarks;               ///< warnings about parts of the file that are not read; reported by read_mesh
  static constexpr std::uint32_t no_material = 0xffffffffu;
};

// The readers parse the file's contents. They throw Error with the reason, and with the line for text files, but without the
// file's name. Indices are checked; positions are not: drop_unusable does that.
MeshData read_ply(std::string_view file);
MeshData read_obj(std::string_view file);
/// Reads the mesh with the given number, counted from 0, of a file with several meshes.
MeshData read_serialized(std::string_view file, std::uint32_t number);
MeshData read_stl(std::string_view file);
MeshData read_off(std::string_view file);
/// Reads a mesh file. The format is determined by the contents (PLY) or the extension. `part` selects one of several meshes in
/// a file, or the faces of one material of an OBJ file: "usemtl brass". Throws Error with the file's name and the reason.
MeshData read_mesh(const std::string& path, const std::string& part = {});

/// A function that reads a part of a file in a registered format; it throws Error with the reason only.
using ReadPart = MeshData (*)(const std::string& path, const std::string& part);
/// Reports a reader's remarks on a file as warnings, each text once.
void tell_remarks(const MeshData&, const std::string& path);

/// Makes those colours white that have a component that is not finite, with one remark on the mesh. `colors` has three numbers
/// for each, in a scale where 1 is white.
void replace_infinite_colors(std::span<float> colors, MeshData&);

/// Registers a reader for files with these extensions (without dots, lower case). Called at the program's start.
bool register_mesh_format(const std::vector<std::string>& endings, ReadPart);

/// The names of an OBJ file's parts: the materials that its faces use, in the order of the file; "" for faces without one.
std::vector<std::string> obj_parts(const std::string& path);

/// Sets every vertex normal to the mean of the normals of the adjacent triangles, weighted by their angles at the vertex
/// (Thuermer & Wuethrich 1998, Computing vertex normals from polygonal facets).
void smooth_normals(MeshData&);

/// Removes triangles with a vertex that is not finite and triangles without area, with one warning for each kind that names
/// `whose`. Throws NoTriangles if nothing is left. For a deforming mesh, `later` holds all positions at the second key, then
/// those at the third, and so on: a triangle without area is removed only if it has no area at any key. With `counted` the
/// warnings contain the number of triangles; without, the warnings of a file's many parts are identical and reported once.
void drop_unusable(MeshData&, const std::string& whose, std::span<const Point3> later = {}, bool counted = true);

/// Appends the triangles of a polygon given by its corners' indices: a fan if it is convex, else by ear clipping.
void append_polygon(MeshData&, const std::uint32_t* corners, size_t count);

}  // namespace etendue
