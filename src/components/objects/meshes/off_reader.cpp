// OFF files (Geomview's object file format), as text: vertices, which may have normals (N), colours (C) and texture coordinates
// (ST), and polygons, which may have colours: numbers from 0 to 1 that are linear, or bytes that are encoded as sRGB.

#include <algorithm>
#include <cmath>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "geometry/usable_triangles.h"
#include "mesh_data.h"
#include "obj_lines.h"

namespace etendue {
namespace {

/// Moves to the next line that is not empty or a comment; returns false at the end.
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

/// Colours are bytes if any value is above 1; these are decoded from sRGB to linear.
void decode(std::vector<float>& colors, MeshData& mesh) {
  const bool bytes = std::ranges::any_of(colors, [](float x) { return x > 1 && std::isfinite(x); });
  for (float& x : colors)
    if (bytes && std::isfinite(x)) x = float(decode_transfer("srgb", std::clamp(double(x) / 255, 0.0, 1.0)));
  replace_infinite_colors(colors, mesh);
}

/// Colours of faces, given after a face's corners: nothing, an index into a colour map that is not in the file, or red, green,
/// blue and optionally alpha. They are stored for the triangles of the face, which begin at `first`.
class FaceColors {
 public:
  void read(Lines& lines, const MeshData& mesh, size_t first) {
    float rgb[4] = {};
    int count = 0;
    for (; count < 4 && !lines.at_end(); ++count) rgb[count] = lines.number();
    listed_ = listed_ || (count > 0 && count < 3);
    values_.resize(3 * first, grey);
    given_ = given_ || count >= 3;
    for (size_t i = first; i < mesh.triangles.size(); ++i)
      for (int c = 0; c < 3; ++c) values_.push_back(count >= 3 ? rgb[c] : grey);
    unset_.resize(mesh.triangles.size(), count < 3);
  }
  void give(MeshData& mesh) {
    if (listed_) mesh.remarks.emplace_back("colours of faces that are places in a list are left out");
    if (!given_) return;
    decode(values_, mesh);
    for (size_t i = 0; i < unset_.size(); ++i)
      if (unset_[i]) std::fill_n(values_.begin() + std::ptrdiff_t(3 * i), 3, grey);
    mesh.face_attributes.push_back({"face_color", 3, std::move(values_)});
  }

 private:
  static constexpr float grey = 0.7f;
  std::vector<float> values_;
  std::vector<bool> unset_;
  bool given_ = false, listed_ = false;
};

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
  decode(colors.values, mesh);
  if (columns.colors) mesh.attributes.push_back(std::move(colors));
  std::vector<std::uint32_t> corners;
  FaceColors face_colors;
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
    const size_t first = mesh.triangles.size();
    append_polygon(mesh, corners.data(), corners.size());
    face_colors.read(lines, mesh, first);
  }
  face_colors.give(mesh);
  if (mesh.triangles.empty()) throw NoTriangles("it has no faces");
  return mesh;
}

}  // namespace etendue
