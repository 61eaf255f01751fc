// PLY files: text and binary of both byte orders (Turk 1994, "The PLY polygon file format").

#include <fmt/format.h>

#include <cstring>

#include "etendue/core/error.h"
#include "geometry/inner_origin.h"
#include "geometry/usable_triangles.h"
#include "mesh_data.h"
#include "ply_attributes.h"
#include "polygon_mesh.h"

namespace etendue {
namespace {

using namespace ply;

void read_vertices(const Element& e, Body& body, MeshData& mesh) {
  const int x = e.find({"x"}), y = e.find({"y"}), z = e.find({"z"});
  if (x < 0 || y < 0 || z < 0) throw Error("the vertices have no x, y and z");
  const int nx = e.find({"nx"}), ny = e.find({"ny"}), nz = e.find({"nz"});
  const int u = e.find({"u", "s", "texture_u", "texture_s"}), v = e.find({"v", "t", "texture_v", "texture_t"});
  const bool normals = nx >= 0 && ny >= 0 && nz >= 0, uvs = u >= 0 && v >= 0;
  const size_t count = size_t(e.count);
  mesh.positions.reserve(count + 1);  // one more, for the padding the object adds
  mesh.positions.resize(count);
  // Positions in double are stored relative to their centre if it is far from the origin.
  const int axes[3] = {x, y, z};
  const bool in_double = std::ranges::all_of(axes, [&](int i) { return e.properties[size_t(i)].type == Type::float64; });
  std::vector<DoublePoint3> exact(in_double ? count : 0);
  if (normals) mesh.normals.resize(count);
  if (uvs) mesh.uvs.resize(count);
  const auto at = [](void* array, size_t component) { return static_cast<char*>(array) + 4 * component; };
  void *const p = mesh.positions.data(), *const n = mesh.normals.data(), *const uv = mesh.uvs.data();
  std::vector<Column> columns{{x, at(p, 0), 12}, {y, at(p, 1), 12}, {z, at(p, 2), 12}};
  if (normals) columns.insert(columns.end(), {{nx, at(n, 0), 12}, {ny, at(n, 1), 12}, {nz, at(n, 2), 12}});
  if (uvs) columns.insert(columns.end(), {{u, at(uv, 0), 8}, {v, at(uv, 1), 8}});
  add_attributes(e, columns, mesh);

  if (!body.text() && e.fixed_size()) {
    std::vector<size_t> offsets;
    size_t stride = 0;
    for (const Property& property : e.properties) {
      offsets.push_back(stride);
      stride += size_of(property.type);
    }
    if (stride == 0 || body.left() / stride < count) body.truncated();
    const auto plain = [&](int i) { return !body.swap() && e.properties[size_t(i)].type == Type::float32; };
    if (y == x + 1 && z == x + 2 && stride == 12 && plain(x) && plain(y) && plain(z)) {
      std::memcpy(p, body.at(), 12 * count);
      columns.clear();
    }
    // Column by column, so that the type is dispatched once per column.
    for (const Column& c : columns) {
      const char* from = body.at() + offsets[size_t(c.property)];
      const Type type = e.properties[size_t(c.property)].type;
      char* to = c.to;
      if (plain(c.property)) {
        for (size_t i = 0; i < count; ++i, from += stride, to += c.step) std::memcpy(to, from, 4);
      } else {
        for (size_t i = 0; i < count; ++i, from += stride, to += c.step) {
          const float value = float(load_number(from, type, body.swap()));
          std::memcpy(to, &value, 4);
        }
      }
    }
    for (size_t i = 0; i < exact.size(); ++i)
      for (int k = 0; k < 3; ++k)
        exact[i][k] = load_number(body.at() + i * stride + offsets[size_t(axes[k])], Type::float64, body.swap());
    body.advance(stride * count);
  } else {
    std::vector<float> row(e.properties.size());
    for (size_t i = 0; i < count; ++i) {
      for (size_t k = 0; k < row.size(); ++k) {
        if (e.properties[k].list) {
          body.skip(e.properties[k]);
          continue;
        }
        const double value = body.number(e.properties[k].type);
        row[k] = float(value);
        for (int axis = 0; in_double && axis < 3; ++axis)
          if (size_t(axes[axis]) == k) exact[i][axis] = value;
      }
      for (const Column& c : columns) std::memcpy(c.to + i * c.step, &row[size_t(c.property)], 4);
    }
  }
  mesh.centre = inner_origin_for(exact);
  if (mesh.centre != DoublePoint3{}) mesh.positions = relative_to(mesh.centre, exact);
  decode_fractions(e, columns);
  replace_infinite_colors(mesh.attributes, mesh);
}

/// If `polygons` is given, faces are stored there without triangulation, and no triangles are made.
void read_faces(const Element& e, Body& body, MeshData& mesh, PolygonMesh* polygons) {
  const int indices = e.find({"vertex_indices", "vertex_index"});
  if (indices < 0 || !e.properties[size_t(indices)].list) throw Error("the faces have no list 'vertex_indices'");
  const std::uint64_t vertices = mesh.positions.size();
  if (polygons)
    polygons->face_sizes.reserve(size_t(e.count));
  else
    mesh.triangles.reserve(size_t(e.count));
  const auto out_of_range = [&](std::uint64_t face, double index) {
    body.error(fmt::format("face {} refers to vertex {:.12g} of {} (counting from 0)", face, index, vertices));
  };
  const Property& list = e.properties[size_t(indices)];
  std::uint64_t face = 0;
  if (!polygons && !body.text() && e.properties.size() == 1 && size_of(list.count_type) == 1 && size_of(list.type) == 4 &&
      list.type != Type::float32) {
    // The common layout: a byte and that many 32-bit indices. Triangles are read here, any other face below.
    const char* at = body.at();
    const char* const end = at + body.left();
    const bool swap = body.swap();
    for (; face < e.count && end - at >= 13 && *at == 3; ++face, at += 13) {
      std::array<std::uint32_t, 3> t;
      std::memcpy(t.data(), at + 1, 12);
      if (swap)
        for (std::uint32_t& i : t) i = __builtin_bswap32(i);
      if (t[0] >= vertices || t[1] >= vertices || t[2] >= vertices) break;  // reported below
      mesh.triangles.push_back(t);
    }
    body.advance(size_t(at - body.at()));
  }
  std::vector<std::uint32_t> corners;
  MeshData unused;
  FaceAttributes attributes(e, indices, polygons ? unused : mesh);
  std::vector<float> row(e.properties.size());
  for (; face < e.count; ++face) {
    for (const Property& p : e.properties) {
      if (&p != &list) {
        if (p.list || polygons)
          body.skip(p);
        else
          row[size_t(&p - e.properties.data())] = float(body.number(p.type));
        continue;
      }
      const std::uint64_t n = body.count(p);
      corners.clear();
      for (std::uint64_t i = 0; i < n; ++i) {
        const double index = body.number(p.type);
        if (!(index >= 0 && index < double(vertices))) out_of_range(face, index);
        corners.push_back(std::uint32_t(index));
      }
      if (!polygons) {
        append_polygon(mesh, corners.data(), corners.size());
      } else {
        polygons->face_sizes.push_back(std::uint32_t(corners.size()));
        polygons->corners.insert(polygons->corners.end(), corners.begin(), corners.end());
      }
    }
    if (!polygons && !attributes.empty()) attributes.add(row);
  }
  if (!polygons) attributes.finish();
}

/// Triangle strips: each corner from the third on forms a triangle with the two before it, with alternating orientation; -1
/// begins a new strip (Stanford's scans).
void read_strips(const Element& e, Body& body, MeshData& mesh, PolygonMesh* polygons) {
  const int indices = e.find({"vertex_indices", "vertex_index"});
  if (indices < 0 || !e.properties[size_t(indices)].list) throw Error("the strips have no list 'vertex_indices'");
  const double vertices = double(mesh.positions.size());
  for (std::uint64_t i = 0; i < e.count; ++i)
    for (const Property& p : e.properties) {
      if (&p != &e.properties[size_t(indices)]) {
        body.skip(p);
        continue;
      }
      std::array<std::uint32_t, 2> last{};
      size_t length = 0;
      for (std::uint64_t left = body.count(p); left > 0; --left) {
        const double index = body.number(p.type);
        if (index == -1) {
          length = 0;
          continue;
        }
        if (!(index >= 0 && index < vertices))
          body.error(fmt::format("a strip refers to vertex {:.12g} of {:.12g} (counting from 0)", index, vertices));
        const auto corner = std::uint32_t(index);
        if (++length > 2) {
          const std::array<std::uint32_t, 3> t{last[length % 2 == 1 ? 0 : 1], last[length % 2 == 1 ? 1 : 0], corner};
          if (!polygons) {
            mesh.triangles.push_back(t);
          } else {
            polygons->face_sizes.push_back(3);
            polygons->corners.insert(polygons->corners.end(), t.begin(), t.end());
          }
        }
        last = {last[1], corner};
      }
    }
}

MeshData parse(std::string_view file, PolygonMesh* polygons) {
  const Header header = read_header(file);
  Body body(file, header.size, header.text, header.swap);
  MeshData mesh;
  bool vertices = false, faces = false;
  for (const Element& e : header.elements) {
    if (e.properties.empty() || e.count == 0) continue;
    // No memory is reserved for a count that exceeds the rest of the file (in a text file, no separator follows the last
    // number).
    const size_t least = e.least_size(header.text);
    if (least == 0 || e.count > (body.left() + 1) / least)
      throw Error("the header claims " + std::to_string(e.count) + " of element " + shown(e.name) +
                  ", more than the file holds");
    if (e.name == "vertex") {
      if (e.count > 0xffffffffu) throw Error("more than 2^32 vertices");
      read_vertices(e, body, mesh);
      vertices = true;
    } else if (e.name == "face") {
      if (!vertices) throw Error("faces come before the vertices they refer to");
      if (e.find({"texcoord"}) >= 0) mesh.remarks.emplace_back("surface coordinates of the corners of faces are left out");
      read_faces(e, body, mesh, polygons);
      faces = true;
    } else if (e.name == "tristrips") {
      if (!vertices) throw Error("strips come before the vertices they refer to");
      read_strips(e, body, mesh, polygons);
      faces = true;
    } else {
      for (std::uint64_t i = 0; i < e.count; ++i)
        for (const Property& p : e.properties) body.skip(p);
    }
    if (vertices && faces) break;
  }
  mesh.texture = header.texture;
  if (!vertices) throw Error("it has no vertices");
  if (polygons ? polygons->face_sizes.empty() : mesh.triangles.empty()) throw NoTriangles("it has no faces");
  return mesh;
}

}  // namespace

MeshData read_ply(std::string_view file) { return parse(file, nullptr); }

PolygonMesh read_ply_polygons(std::string_view file) {
  PolygonMesh polygons;
  MeshData mesh = parse(file, &polygons);
  polygons.positions = std::move(mesh.positions);
  polygons.centre = mesh.centre;
  polygons.uvs = std::move(mesh.uvs);
  if (!polygons.uvs.empty()) polygons.uv_corners = polygons.corners;
  polygons.attributes = std::move(mesh.attributes);
  return polygons;
}

}  // namespace etendue
