#pragma once
// What the vertices of a PLY file have besides positions, normals and surface coordinates.

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

/// Adds attributes to the mesh, with room for every vertex, and columns that fill them: "color" of the properties red, green
/// and blue, and every other number that no column takes yet by its own name.
void add_attributes(const Element&, std::vector<Column>&, MeshData&);

/// When the columns are filled: colours and alpha that were integers become fractions of the largest integer of their type,
/// and such colours, which are encoded as in sRGB, linear.
void decode_fractions(const Element&, const std::vector<Column>&);

}  // namespace etendue::ply
