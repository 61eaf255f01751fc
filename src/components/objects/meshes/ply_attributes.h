#pragma once
// Further attributes of a PLY file: of vertices besides positions, normals and texture coordinates, and of faces besides
// corners.

#include "mesh_data.h"
#include "ply_header.h"

namespace etendue::ply {

/// The destination of a property's values as floats: one every `step` bytes.
struct Column {
  int property;
  char* to;
  size_t step;
  /// How decode_fractions converts integers.
  enum class Meaning : std::uint8_t { number, color, fraction } meaning = Meaning::number;
};

/// Properties that make up one attribute.
struct Group {
  std::string name;
  std::vector<int> properties;
  Column::Meaning meaning = Column::Meaning::number;
};
/// The groups of an element's properties, except those that are `taken`: "color" from the properties red, green and blue; NAME
/// from NAME_0, NAME_1, ..., up to four; and every other scalar property by its own name.
std::vector<Group> groups_of(const Element&, std::vector<bool> taken);

/// For each property that no column reads yet, adds an attribute to the mesh, with storage for every vertex, and the columns
/// that fill it.
void add_attributes(const Element&, std::vector<Column>&, MeshData&);

/// Attributes of faces, stored for each triangle under the name "face_" and the group's name.
class FaceAttributes {
 public:
  FaceAttributes(const Element&, int indices, MeshData&);
  bool empty() const { return groups_.empty(); }
  /// Stores one face's values, indexed by property, for each triangle that was added for the face.
  void add(const std::vector<float>& row);
  /// To be called after the last face; see decode_fractions.
  void finish();

 private:
  const Element& element_;
  MeshData& mesh_;
  std::vector<Group> groups_;
  size_t triangles_ = 0;
};

/// To be called when the columns are filled: converts integer colours and alpha to fractions of the largest integer of their
/// type, and decodes such colours from sRGB to linear.
void decode_fractions(const Element&, const std::vector<Column>&);

/// Calls etendue::replace_infinite_colors for the colours among attributes of the mesh.
void replace_infinite_colors(std::vector<VertexAttribute>&, MeshData&);

}  // namespace etendue::ply
