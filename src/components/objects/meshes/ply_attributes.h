#pragma once
// What the vertices of a PLY file have besides positions, normals and surface coordinates, and its faces besides corners.

#include "mesh_data.h"
#include "ply_header.h"

namespace etendue::ply {

/// Where the numbers of a property go as floats: one every `step` bytes.
struct Column {
  int property;
  char* to;
  size_t step;
  /// What decode_fractions makes of integers.
  enum class Meaning : std::uint8_t { number, color, fraction } meaning = Meaning::number;
};

/// Properties that make up one attribute.
struct Group {
  std::string name;
  std::vector<int> properties;
  Column::Meaning meaning = Column::Meaning::number;
};
/// Those of an element but for what is `taken`: "color" of the properties red, green and blue; NAME of NAME_0, NAME_1, ..., up
/// to four; and every other number by its own name.
std::vector<Group> groups_of(const Element&, std::vector<bool> taken);

/// Adds attributes to the mesh, with room for every vertex, and columns that fill them, of what no column takes yet.
void add_attributes(const Element&, std::vector<Column>&, MeshData&);

/// What the faces tell, kept for each triangle: "face_" and the name of the group.
class FaceAttributes {
 public:
  FaceAttributes(const Element&, int indices, MeshData&);
  bool empty() const { return groups_.empty(); }
  /// One face's numbers, by property, for each triangle that was added for it.
  void add(const std::vector<float>& row);
  /// When all are there; see decode_fractions.
  void finish();

 private:
  const Element& element_;
  MeshData& mesh_;
  std::vector<Group> groups_;
  size_t triangles_ = 0;
};

/// When the columns are filled: colours and alpha that were integers become fractions of the largest integer of their type,
/// and such colours, which are encoded as in sRGB, linear.
void decode_fractions(const Element&, const std::vector<Column>&);

}  // namespace etendue::ply
