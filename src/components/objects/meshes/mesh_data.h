#pragma once
// Triangles as they come from a file or a list, and how they are read.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// Numbers by vertex, or by triangle, `width` for each.
struct VertexAttribute {
  std::string name;
  int width = 1;
  std::vector<float> values;
};

/// Triangles with shared vertices. Normals and uvs are by vertex, or absent.
struct MeshData {
  std::vector<Point3> positions;
  DoublePoint3 centre;  ///< what they are counted from, in the object's coordinates
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Normal3> normals;  ///< a zero normal: the vertex has none
  std::vector<Point2> uvs;
  std::vector<VertexAttribute> attributes;       ///< "color" (linear sRGB) and whatever else a file tells of its vertices
  std::vector<VertexAttribute> face_attributes;  ///< of triangles: those of the faces they are part of; "face_" and a name
  std::vector<std::string> materials;            ///< names of those that the file uses, each once; nothing more is read of them
  bool faceted = false;                          ///< the file says that it is to look so, not smooth
  std::vector<std::uint32_t> triangle_materials;  ///< for each triangle, by their places in `materials`; or empty
  std::string texture;                            ///< the image that a PLY file names for its surface coordinates
  std::vector<std::string> remarks;               ///< what of the file is not read; read_mesh tells it
  static constexpr std::uint32_t no_material = 0xffffffffu;
};

// The readers take the file's contents. They throw Error("what is wrong"), with the line for text, without the file's name.
// Indices are checked, positions are not: that is for drop_unusable.
MeshData read_ply(std::string_view file);
MeshData read_obj(std::string_view file);
/// Of a file that holds several meshes the one of this number, counted from 0.
MeshData read_serialized(std::string_view file, std::uint32_t number);
MeshData read_stl(std::string_view file);
MeshData read_off(std::string_view file);
/// By the file's contents (PLY) or the ending of its name. `part` names one of several meshes in a file; of an OBJ file the
/// faces of a material, "usemtl brass". Throws Error("'name': what is wrong").
MeshData read_mesh(const std::string& path, const std::string& part = {});

/// Reads a part of a file of a format that is not known here; throws Error with the reason alone.
using ReadPart = MeshData (*)(const std::string& path, const std::string& part);
/// Tells once for each text what a reader remarked on a file.
void tell_remarks(const MeshData&, const std::string& path);

/// Says who reads files with these endings (without dots, small letters). At the program's start.
bool register_mesh_format(const std::vector<std::string>& endings, ReadPart);

/// The parts of an OBJ file by the materials that its faces use, in the order of the file; "" for those without one.
std::vector<std::string> obj_parts(const std::string& path);

/// Gives every vertex the mean of the normals of the triangles around it, by their angles there (Thuermer & Wuethrich 1998,
/// Computing vertex normals from polygonal facets).
void smooth_normals(MeshData&);

/// Removes triangles with a corner that is not finite and triangles without area, with one warning for each kind that
/// names `whose`. Throws Error when nothing is left. Of a mesh that changes its shape, `later` holds all positions at the
/// second key, then those at the third, and so on: triangles go only when they have no area at any key.
/// `counted`: the warnings say how many; of the many parts of a file they are told once instead.
void drop_unusable(MeshData&, const std::string& whose, std::span<const Point3> later = {}, bool counted = true);

/// Appends the triangles of a polygon given by its corners' indices: a fan when it is convex, else by cutting ears.
void append_polygon(MeshData&, const std::uint32_t* corners, size_t count);

}  // namespace etendue
