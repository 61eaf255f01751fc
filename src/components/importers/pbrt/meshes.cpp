// Meshes: inline, from files, bilinear patches, subdivision surfaces.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "components/objects/meshes/mesh_fronts.h"
#include "geometry/usable_triangles.h"
#include "meshes.h"

namespace etendue::pbrt {

namespace {

/// Checks the indices of a list: integers below the number of vertices.
void check_indices(const Parameters& p, const std::vector<double>& indices, size_t vertices) {
  for (const double i : indices)
    if (!(i >= 0 && i < double(vertices) && i == std::floor(i)))
      throw LeftOut(fmt::format("{} names the vertex {}, but there are {}, counted from 0", p.of, i, vertices),
                    p.place("indices"));
}

/// Whether any face, of this many corners in row order, has a nonzero area at the precision in which it is stored. Adds a
/// warning if none has.
bool has_area(Reader& reader, const std::vector<double>& p, const std::vector<double>& indices, size_t corners, Location at) {
  const std::vector<Point3> shifted = points_of(p);
  for (size_t f = 0; f + corners <= indices.size(); f += corners)
    for (size_t last = 2; last < corners; ++last) {
      const std::array<std::uint32_t, 3> triangle{std::uint32_t(indices[f + last - 2]), std::uint32_t(indices[f + last - 1]),
                                                  std::uint32_t(indices[f + last])};
      if (any_usable(shifted, {&triangle, 1})) return true;
    }
  reader.importing.inexact("a mesh whose triangles have no area is left out", at);
  return false;
}

}  // namespace

Shape object_of(Reader& reader, Mesh&& mesh, Location at) {
  if (!has_area(reader, mesh.positions, mesh.indices, 3, at)) return {};
  if (!mesh.normals.empty()) face_normals(mesh);
  if (reader.state.reversed) turn_round(mesh);
  if (holds_medium(reader.state) && inside_out(mesh.positions, mesh.indices)) {
    turn_round(mesh);
    reader.importing.inexact(medium_outside, at);
  }
  const Ref<Component> object = reader.make("TriangleMesh", at);
  const size_t triangles = mesh.indices.size() / 3;
  const auto give = [&](const char* member, std::vector<double>&& list, int width) {
    if (!list.empty()) set_member(*object, member, Numbers{std::move(list), width, Dimension::none}, at);
    list = {};
  };
  give("positions", std::move(mesh.positions), 3);
  give("triangles", std::move(mesh.indices), 1);
  give("normals", std::move(mesh.normals), 3);
  give("uvs", std::move(mesh.uvs), 2);
  return {object, {}, false, triangles};
}

namespace {

Shape triangle_mesh(Reader& reader, Parameters& p) {
  Mesh mesh;
  mesh.positions = p.take_numbers("P", 3);
  mesh.indices = p.take_numbers("indices");
  const size_t vertices = mesh.positions.size() / 3;
  if (vertices == 0) throw LeftOut(fmt::format("{} needs vertices, 'P'", p.of), p.place("P"));
  if (mesh.indices.empty() && vertices == 3) mesh.indices = {0, 1, 2};
  if (mesh.indices.size() % 3 != 0) {
    reader.importing.inexact(
        fmt::format("{} has {} indices, but each triangle takes 3: the last are left out", p.of, mesh.indices.size()),
        p.place("indices"));
    mesh.indices.resize(mesh.indices.size() / 3 * 3);
  }
  if (mesh.indices.empty()) throw LeftOut(fmt::format("{} has no triangles", p.of), p.place("indices"));
  check_indices(p, mesh.indices, vertices);
  const auto by_vertex = [&](std::vector<double> list, size_t width, const char* name) {
    if (list.empty() || list.size() == vertices * width) return list;
    reader.importing.inexact(
        fmt::format("{} has {} '{}' for {} vertices: they are left out", p.of, list.size() / width, name, vertices),
        p.place(name));
    return std::vector<double>();
  };
  mesh.normals = by_vertex(p.take_numbers("N", 3), 3, "N");
  for (const char* name : {"uv", "st", "UV"})
    if (mesh.uvs.empty()) mesh.uvs = by_vertex(p.take_numbers(name, 2), 2, name);
  return object_of(reader, std::move(mesh), p.at);
}

/// Copies a file's triangles into an inline mesh: needed where the file's normals determine the front.
Mesh written_out(const MeshData& data) {
  Mesh mesh;
  for (const Point3& q : data.positions)
    mesh.positions.insert(mesh.positions.end(),
                          {double(q.x) + data.centre.x, double(q.y) + data.centre.y, double(q.z) + data.centre.z});
  for (const auto& t : data.triangles) mesh.indices.insert(mesh.indices.end(), {double(t[0]), double(t[1]), double(t[2])});
  for (const Normal3& n : data.normals) mesh.normals.insert(mesh.normals.end(), {double(n.x), double(n.y), double(n.z)});
  for (const Point2& t : data.uvs) mesh.uvs.insert(mesh.uvs.end(), {double(t.x), double(t.y)});
  return mesh;
}

/// The file of a mesh. If it is missing, version 3 continues without the mesh.
std::string mesh_file(const Reader& reader, const Parameters& p) {
  const std::string named = p.text("filename");
  if (named.empty()) throw Error(fmt::format("{} needs 'filename'", p.of), p.at);
  const Location at = p.place("filename");
  try {
    return reader.importing.file(named, at, p.folder);
  } catch (const Error& e) {
    if (reader.version == 3) throw LeftOut(e.what(), at);
    throw;
  }
}

Shape ply_mesh(Reader& reader, const Parameters& p) {
  const std::string path = mesh_file(reader, p);
  if (p.has("displacement")) {
    const Ref<Component> inner = reader.make("TriangleMesh", p.at);
    set_member(*inner, "file", FilePath{path, {}}, p.place("filename"));
    const Ref<Component> moved = reader.make("DisplacedMesh", p.at);
    set_member(*moved, "surface", inner, p.at);
    set_map(*moved, "displacement", number_map(reader, p, {"displacement"}, 0), p.at);
    set_member(*moved, "edge_length", p.number("edgelength", 1), p.at);
    return {moved, {}, reader.state.reversed};
  }
  size_t triangles = 1;
  if (front_matters(reader)) {
    try {
      MeshData data = read_mesh(path);
      const bool turned = turn_to_normals(data);
      if (turned || reader.state.reversed || (holds_medium(reader.state) && inside_out(data)))
        return object_of(reader, written_out(data), p.at);
      triangles = data.triangles.size();
    } catch (const NoTriangles& e) {
      reader.importing.inexact(fmt::format("{}: it is left out", e.what()), p.place("filename"));
      return {};
    } catch (const Error& e) {
      throw Error(e.what(), p.place("filename"));
    }
  }
  const Ref<Component> object = reader.make("TriangleMesh", p.at);
  set_member(*object, "file", FilePath{path, {}}, p.place("filename"));
  return {object, {}, false, triangles};
}

/// Whether each patch has the default texture coordinates.
bool corners_of_square(const std::vector<double>& uvs, const std::vector<double>& indices) {
  for (size_t i = 0; i < indices.size(); ++i) {
    const size_t v = 2 * size_t(indices[i]);
    if (uvs[v] != double(i % 2) || uvs[v + 1] != double(i / 2 % 2)) return false;
  }
  return true;
}

Shape bilinear_mesh(Reader& reader, Parameters& p) {
  std::vector<double> points = p.take_numbers("P", 3), indices = p.take_numbers("indices");
  const size_t vertices = points.size() / 3;
  if (vertices == 0) throw Error(fmt::format("{} needs vertices, 'P'", p.of), p.place("P"));
  if (indices.empty() && vertices == 4) indices = {0, 1, 2, 3};
  if (indices.empty() || indices.size() % 4 != 0)
    throw Error(fmt::format("{} has {} indices, but each patch takes 4", p.of, indices.size()), p.place("indices"));
  check_indices(p, indices, vertices);
  if (!has_area(reader, points, indices, 4, p.at)) {
    p.forget();
    return {};
  }
  if (p.has("N")) reader.importing.inexact("normals of vertices of bilinear patches are left out", p.place("N"));
  const std::vector<double>& uvs = p.numbers("uv", 2);
  if (uvs.size() / 2 == vertices && !corners_of_square(uvs, indices))
    reader.importing.inexact("each bilinear patch has its own surface coordinates from 0 to 1", p.place("uv"));
  const size_t patches = indices.size() / 4;
  const size_t a = size_t(indices[0]), b = size_t(indices[1]), c = size_t(indices[2]), d = size_t(indices[3]);
  const Vertex u = difference(points, b, a), v = difference(points, c, a), top = difference(points, d, c);
  double off = 0, size = 0;
  for (size_t i = 0; i < 3; ++i) {
    off += std::abs(top[i] - u[i]);
    size += std::abs(u[i]) + std::abs(v[i]);
  }
  const bool rectangle = patches == 1 && off <= 1e-6 * size;
  const Ref<Component> object = reader.make(rectangle ? "Rectangle" : "BezierPatches", p.at);
  if (rectangle) {
    set_member(*object, "corner", Numbers{{points[3 * a], points[3 * a + 1], points[3 * a + 2]}, 1, Dimension::none}, p.at);
    set_member(*object, "edge_u", Numbers{{u[0], u[1], u[2]}, 1, Dimension::none}, p.at);
    set_member(*object, "edge_v", Numbers{{v[0], v[1], v[2]}, 1, Dimension::none}, p.at);
  } else {
    set_member(*object, "degree_u", 1, p.at);
    set_member(*object, "degree_v", 1, p.at);
    set_member(*object, "points", Numbers{std::move(points), 3, Dimension::none}, p.at);
    set_member(*object, "patches", Numbers{std::move(indices), 1, Dimension::none}, p.at);
  }
  return {object, {}, reader.state.reversed, patches};
}

Shape loop_subdivision(Reader& reader, Parameters& p) {
  std::vector<double> points = p.take_numbers("P", 3), indices = p.take_numbers("indices");
  if (points.empty()) throw Error(fmt::format("{} needs vertices, 'P'", p.of), p.place("P"));
  if (indices.empty() || indices.size() % 3 != 0)
    throw Error(fmt::format("{} has {} indices, but each triangle takes 3", p.of, indices.size()), p.place("indices"));
  check_indices(p, indices, points.size() / 3);
  if (!has_area(reader, points, indices, 3, p.at)) {
    p.forget();
    return {};
  }
  bool turned = reader.state.reversed;
  if (holds_medium(reader.state) && inside_out(points, indices)) {
    turn_faces(indices);
    if (!turned) reader.importing.inexact(medium_outside, p.at);
    turned = false;
  }
  const int levels = p.integer(p.has("nlevels") ? "nlevels" : "levels", 3);
  const Ref<Component> object = reader.make("SubdivisionSurface", p.at);
  set_member(*object, "positions", Numbers{std::move(points), 3, Dimension::none}, p.at);
  set_member(*object, "indices", Numbers{std::move(indices), 1, Dimension::none}, p.at);
  set_member(*object, "scheme", "loop", p.at);
  set_member(*object, "levels", std::clamp(levels, 0, 10), p.at);
  if (const std::string scheme = p.text("scheme", "loop"); scheme != "loop")
    reader.importing.inexact(fmt::format("the scheme '{}' is taken for loop", scheme), p.place("scheme"));
  return {object, {}, turned};
}

/// A height field over the unit square, with two triangles for each cell.
Shape height_field(Reader& reader, Parameters& p) {
  const int nu = p.integer("nu", -1), nv = p.integer("nv", -1);
  const std::vector<double> heights = p.take_numbers("Pz");
  if (nu < 2 || nv < 2 || double(nu) * nv != double(heights.size()))
    throw Error(fmt::format("a height field of {} times {} cannot have {} heights", nu, nv, heights.size()), p.at);
  Mesh mesh;
  for (int y = 0; y < nv; ++y)
    for (int x = 0; x < nu; ++x) {
      const double u = double(x) / (nu - 1), v = double(y) / (nv - 1);
      mesh.positions.insert(mesh.positions.end(), {u, v, heights[size_t(y) * size_t(nu) + size_t(x)]});
      mesh.uvs.insert(mesh.uvs.end(), {u, v});
    }
  for (int y = 0; y + 1 < nv; ++y)
    for (int x = 0; x + 1 < nu; ++x) {
      const double a = double(y) * nu + x, b = a + 1, c = a + nu, d = c + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
    }
  return object_of(reader, std::move(mesh), p.at);
}

}  // namespace

Shape make_mesh(Reader& reader, const std::string& type, Parameters& p) {
  if (type == "trianglemesh") return triangle_mesh(reader, p);
  if (type == "plymesh") return ply_mesh(reader, p);
  if (type == "bilinearmesh") return bilinear_mesh(reader, p);
  if (type == "loopsubdiv") return loop_subdivision(reader, p);
  if (type == "heightfield") return height_field(reader, p);
  if (type == "nurbs") {
    reader.importing.inexact("a NURBS surface is not read: it is left out", p.at);
    p.forget();
    return {};
  }
  throw LeftOut(
      fmt::format("there is no shape '{}'{}", type,
                  suggestion(type, {"sphere", "cylinder", "disk", "cone", "paraboloid", "hyperboloid", "curve", "trianglemesh",
                                    "plymesh", "bilinearmesh", "loopsubdiv", "heightfield", "nurbs"})),
      p.at);
}

}  // namespace etendue::pbrt
