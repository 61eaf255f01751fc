// OFF files (Geomview's object file format), as text: vertices, which may have normals (N), colours (C) and texture coordinates
// (ST), and polygons.

#include "etendue/core/error.h"
#include "mesh_data.h"
#include "obj_lines.h"

namespace etendue {
namespace {

/// The lines that say something.
bool next(Lines& lines) {
  while (lines.next())
    if (!lines.at_end()) return true;
  return false;
}

struct Columns {
  bool normals = false, colors = false, uvs = false;
};

Columns read_kind(std::string_view word) {
  Columns columns;
  if (!word.ends_with("OFF")) throw Error("it does not begin with OFF");
  word.remove_suffix(3);
  if (word.starts_with("ST")) {
    columns.uvs = true;
    word.remove_prefix(2);
  }
  if (word.starts_with("C")) {
    columns.colors = true;
    word.remove_prefix(1);
  }
  if (word.starts_with("N")) {
    columns.normals = true;
    word.remove_prefix(1);
  }
  if (!word.empty()) throw Error("OFF files of four or n dimensions are not read");
  return columns;
}

size_t count(Lines& lines, std::string_view file, const char* what) {
  const std::int64_t n = lines.integer();
  if (n < 0 || std::uint64_t(n) > file.size()) lines.error(std::string("so many ") + what + " cannot be in it");
  return size_t(n);
}

}  // namespace

MeshData read_off(std::string_view file) {
  Lines lines(file);
  if (!next(lines)) throw Error("the file is empty");
  const Columns columns = read_kind(lines.keyword());
  if (lines.at_end() && !next(lines)) throw Error("it ends before its counts");
  if (lines.rest() == "BINARY") throw Error("binary OFF files are not read");
  const size_t vertices = count(lines, file, "vertices");
  lines.at_end();
  const size_t faces = count(lines, file, "faces");
  MeshData mesh;
  VertexAttribute colors{"color", 3, {}};
  for (size_t i = 0; i < vertices; ++i) {
    if (!next(lines)) throw Error("it ends after " + std::to_string(i) + " of " + std::to_string(vertices) + " vertices");
    const float x = lines.number(), y = lines.number(), z = lines.number();
    mesh.positions.push_back({x, y, z});
    if (columns.normals) {
      const float nx = lines.number(), ny = lines.number(), nz = lines.number();
      mesh.normals.push_back({nx, ny, nz});
    }
    if (columns.colors) {
      for (int k = 0; k < 3; ++k) colors.values.push_back(lines.number());
      if (!lines.at_end()) lines.number();  // alpha
    }
    if (columns.uvs) {
      const float u = lines.number();
      mesh.uvs.push_back({u, lines.number()});
    }
  }
  if (columns.colors) mesh.attributes.push_back(std::move(colors));
  std::vector<std::uint32_t> corners;
  for (size_t i = 0; i < faces; ++i) {
    if (!next(lines)) throw Error("it ends after " + std::to_string(i) + " of " + std::to_string(faces) + " faces");
    const size_t n = count(lines, file, "corners");
    corners.clear();
    for (size_t k = 0; k < n; ++k) {
      if (lines.at_end()) lines.error("a corner is missing");
      const std::int64_t vertex = lines.integer();
      if (vertex < 0 || std::uint64_t(vertex) >= vertices)
        lines.error("refers to vertex " + std::to_string(vertex) + " of " + std::to_string(vertices) + " (counting from 0)");
      corners.push_back(std::uint32_t(vertex));
    }
    append_polygon(mesh, corners.data(), corners.size());
  }
  if (mesh.triangles.empty()) throw Error("it has no faces");
  return mesh;
}

}  // namespace etendue
