// Wavefront OBJ files: v, vt, vn, f, s and usemtl, and colours of vertices (obj_vertices.h). The names of materials and the
// material of each triangle are stored: ObjImporter creates shaders from them. Everything else (groups, curves) is ignored,
// since it does not concern triangles.

#include <unordered_map>

#include "geometry/inner_origin.h"
#include "geometry/triangle_test.h"
#include "geometry/usable_triangles.h"
#include "mesh_data.h"
#include "obj_lines.h"
#include "obj_vertices.h"
#include "polygon_mesh.h"

namespace etendue {
namespace {

/// The smoothing group after "s": a number, or "off" (0).
std::uint32_t smoothing_group(Lines& lines) {
  const std::string_view word = lines.rest();
  std::uint32_t group = 0;
  std::from_chars(word.data(), word.data() + word.size(), group);
  return group;
}

/// A first pass that counts elements, so that indices can be checked immediately and memory is allocated once.
ObjCounts count(std::string_view file) {
  ObjCounts c;
  for (Lines lines(file); lines.next();) {
    const std::string_view word = lines.keyword();
    if (word == "v") ++c.positions;
    if (word == "vt") ++c.uvs;
    if (word == "vn") ++c.normals;
    if (word == "f") ++c.faces;
    if (word == "s" && smoothing_group(lines) > 0) c.smoothed = true;
  }
  if (c.normals > 0) c.smoothed = false;
  return c;
}

/// Replaces the vertex numbers of corners by indices of positions and uvs. A corner without uv gets the uv (0, 0).
void name_corners(const std::vector<Vertices::Corner>& list, PolygonMesh& mesh) {
  if (!mesh.uvs.empty()) {
    const auto origin = std::uint32_t(mesh.uvs.size());
    mesh.uvs.push_back({});
    mesh.uv_corners.reserve(mesh.corners.size());
    for (const std::uint32_t c : mesh.corners) mesh.uv_corners.push_back(list[c].uv == Vertices::none ? origin : list[c].uv);
  }
  for (std::uint32_t& c : mesh.corners) c = list[c].position;
}

/// Reads three numbers. What Microsoft's C library wrote for NaN and infinity ("-1.#IND") becomes NaN.
template <class Number>
std::array<Number, 3> three(Lines& lines) {
  const std::string_view rest = lines.rest();
  constexpr Number none = std::numeric_limits<Number>::quiet_NaN();
  try {
    const Number x = lines.number<Number>(), y = lines.number<Number>(), z = lines.number<Number>();
    return {x, y, z};
  } catch (const Error&) {
    for (const char* written : {".#IND", ".#QNAN", ".#SNAN", ".#INF"})
      if (rest.find(written) != std::string_view::npos) return {none, none, none};
    throw;
  }
}

DoublePoint3 read_place(Lines& lines) {
  const auto [x, y, z] = three<double>(lines);
  return {x, y, z};
}

/// The point to which the positions of a file are to be relative. All positions are read only if the first is far from the
/// origin.
DoublePoint3 centre_of(std::string_view file) {
  constexpr double far = 1000;
  std::vector<DoublePoint3> ends;  // the box's corners
  for (Lines lines(file); lines.next();) {
    if (lines.keyword() != "v") continue;
    const DoublePoint3 p = read_place(lines);
    if (!is_finite(p)) continue;
    if (ends.empty()) {
      if (!(length(p - DoublePoint3{}) > far)) return {};
      ends = {p, p};
    }
    for (int k = 0; k < 3; ++k) {
      ends[0][k] = std::min(ends[0][k], p[k]);
      ends[1][k] = std::max(ends[1][k], p[k]);
    }
  }
  return inner_origin_for(ends);
}

/// The angle of a triangle at its first corner [rad].
float angle_at(const Point3& p, const Point3& a, const Point3& b) {
  const Vector3 u = a - p, v = b - p;
  return std::atan2(length(cross(u, v)), dot(u, v));
}

/// Normals from smoothing groups, whose numbers are stored as the vertices' "normals": the mean of the normals of the group's
/// triangles at the position, weighted by their angles there, so that the result does not depend on the triangulation of
/// polygons (Thuermer & Wuethrich 1998, Computing vertex normals from polygonal facets). Vertices of group 0 have no normals,
/// so that its faces are flat.
std::vector<Normal3> smooth_normals(const MeshData& mesh, const std::vector<Vertices::Corner>& corners) {
  const auto key = [&](std::uint32_t i) { return std::uint64_t(corners[i].position) << 32 | corners[i].normal; };
  const auto place = [&](std::uint32_t i) { return mesh.positions[corners[i].position]; };
  std::unordered_map<std::uint64_t, Vector3> sums;
  for (const auto& t : mesh.triangles) {
    const Vector3 area = area_vector(place(t[0]), place(t[1]), place(t[2]));
    const float size = length(area);
    if (!(size > 0 && size < infinity)) continue;
    for (size_t k = 0; k < 3; ++k)
      if (corners[t[k]].normal != 0)
        sums[key(t[k])] += angle_at(place(t[k]), place(t[(k + 1) % 3]), place(t[(k + 2) % 3])) / size * area;
  }
  std::vector<Normal3> normals(corners.size());
  for (std::uint32_t i = 0; i < corners.size(); ++i)
    if (const auto sum = sums.find(key(i)); sum != sums.end()) normals[i] = Normal3(sum->second);
  return normals;
}

/// Converts to one entry of each list per vertex. A corner without normal gets a zero normal, a corner without uv the uv (0,
/// 0).
MeshData by_vertex(MeshData mesh, const Vertices& vertices, bool smoothed) {
  MeshData result;
  result.centre = mesh.centre;
  const auto& list = vertices.corners();
  if (smoothed) result.normals = smooth_normals(mesh, list);
  bool any_uv = false, any_normal = false;
  for (const auto& c : list) {
    any_uv = any_uv || c.uv != Vertices::none;
    any_normal = any_normal || c.normal != Vertices::none;
  }
  result.positions.reserve(list.size() + 1);
  for (const auto& c : list) result.positions.push_back(mesh.positions[c.position]);
  mesh.positions = {};
  if (any_uv) {
    result.uvs.reserve(list.size());
    for (const auto& c : list) result.uvs.push_back(c.uv == Vertices::none ? Point2{} : mesh.uvs[c.uv]);
  }
  mesh.uvs = {};
  if (any_normal && !smoothed) {
    result.normals.reserve(list.size());
    for (const auto& c : list) result.normals.push_back(c.normal == Vertices::none ? Normal3{} : mesh.normals[c.normal]);
  }
  for (VertexAttribute& a : mesh.attributes) {
    VertexAttribute& made = result.attributes.emplace_back(VertexAttribute{a.name, a.width, {}});
    for (const auto& c : list)
      for (int k = 0; k < a.width; ++k) made.values.push_back(a.values[size_t(c.position) * size_t(a.width) + size_t(k)]);
  }
  result.remarks = std::move(mesh.remarks);
  result.triangles = std::move(mesh.triangles);
  result.materials = std::move(mesh.materials);
  result.triangle_materials = std::move(mesh.triangle_materials);
  return result;
}

struct Face {
  std::vector<std::uint32_t> corners, positions;
  std::uint32_t material = 0;
};

/// Triangulates faces by their positions; the triangles' corners are vertex numbers.
class FaceCutter {
 public:
  void cut(const Face& polygon, MeshData& mesh) {
    face_.positions.clear();
    face_.triangles.clear();
    order_.clear();
    for (std::uint32_t p : polygon.positions) {
      order_.push_back(std::uint32_t(face_.positions.size()));
      face_.positions.push_back(mesh.positions[p]);
    }
    append_polygon(face_, order_.data(), order_.size());
    for (const auto& t : face_.triangles)
      mesh.triangles.push_back({polygon.corners[t[0]], polygon.corners[t[1]], polygon.corners[t[2]]});
    mesh.triangle_materials.resize(mesh.triangles.size(), polygon.material);
  }

 private:
  MeshData face_;
  std::vector<std::uint32_t> order_;
};

/// If `polygons` is given, faces are stored there without triangulation, and no triangles are made.
MeshData parse(std::string_view file, PolygonMesh* polygons) {
  const ObjCounts all = count(file);
  if (all.positions == 0) throw Error("it has no vertices");
  if (all.faces == 0) throw NoTriangles("it has no faces");
  if (all.positions >= Vertices::none || all.uvs >= Vertices::none || all.normals >= Vertices::none)
    throw Error("more than 2^32 vertices");
  const bool plain = all.uvs == 0 && all.normals == 0 && !all.smoothed;

  MeshData mesh;  // separate lists as in the file, until all is read
  mesh.centre = centre_of(file);
  mesh.positions.reserve(all.positions + 1);  // one more, for the padding the object adds
  mesh.uvs.reserve(all.uvs);
  mesh.normals.reserve(all.normals);
  mesh.triangles.reserve(all.faces);
  Vertices vertices(plain ? 0 : all.positions);
  std::vector<std::uint32_t> corners, positions;
  std::vector<Face> late;  // faces with more than three corners that precede their vertices in the file
  FaceCutter cutter;
  ObjColors colors(all.positions);
  ObjCornerReader reader(mesh, all);
  size_t not_faces = 0, not_normals = 0;
  std::unordered_map<std::string, std::uint32_t> materials;
  std::uint32_t material = MeshData::no_material, group = 0;
  for (Lines lines(file); lines.next();) {
    const std::string_view word = lines.keyword();
    if (word == "v") {
      mesh.positions.push_back(Point3(DoublePoint3{} + (read_place(lines) - mesh.centre)));
      colors.vertex(lines, mesh.positions.size() - 1);
    } else if (word == "#MRGB") {
      colors.painted(lines);
    } else if (word == "vt") {
      const float u = lines.number();
      mesh.uvs.push_back({u, lines.at_end() ? 0 : lines.number()});
    } else if (word == "vn") {
      const auto [x, y, z] = three<float>(lines);
      const Normal3 normal{x, y, z};
      const bool sound = std::isfinite(x) && std::isfinite(y) && std::isfinite(z);
      if (!sound && not_normals++ == 0)
        mesh.remarks.push_back("line " + std::to_string(lines.line()) + ": a normal that is no number is none");
      mesh.normals.push_back(sound ? normal : Normal3{});
    } else if (word == "usemtl") {
      const auto [place, fresh] = materials.try_emplace(std::string(lines.rest()), std::uint32_t(materials.size()));
      if (fresh) mesh.materials.push_back(place->first);
      material = place->second;
    } else if (word == "s") {
      group = smoothing_group(lines);
    } else if (word == "f") {
      corners.clear();
      positions.clear();
      bool known = true;
      while (!lines.at_end()) {
        ObjCorner c = reader.read(lines);
        if (all.smoothed) c.normal = group;
        known = known && c.position < mesh.positions.size();
        positions.push_back(c.position);
        corners.push_back(plain ? c.position : vertices.find(c.position, c.uv, c.normal));
      }
      if (corners.size() < 3) {
        if (not_faces++ == 0)
          mesh.remarks.push_back("line " + std::to_string(lines.line()) + ": a face of fewer than three vertices is left out");
      } else if (polygons) {
        polygons->face_sizes.push_back(std::uint32_t(corners.size()));
        polygons->corners.insert(polygons->corners.end(), corners.begin(), corners.end());
      } else if (corners.size() == 3) {
        mesh.triangles.push_back({corners[0], corners[1], corners[2]});
        mesh.triangle_materials.push_back(material);
      } else if (!known) {
        late.push_back({corners, positions, material});
      } else {
        cutter.cut({corners, positions, material}, mesh);
      }
    }
  }
  if (not_faces == all.faces) throw NoTriangles("it has no faces of three or more vertices");
  if (polygons) {
    polygons->positions = std::move(mesh.positions);
    polygons->centre = mesh.centre;
    polygons->uvs = std::move(mesh.uvs);
    if (!plain) name_corners(vertices.corners(), *polygons);
    return mesh;
  }
  for (const Face& polygon : late) cutter.cut(polygon, mesh);
  if (mesh.materials.empty()) mesh.triangle_materials = {};
  colors.give(mesh);
  if (plain) return mesh;
  return by_vertex(std::move(mesh), vertices, all.smoothed);
}

}  // namespace

MeshData read_obj(std::string_view file) { return parse(file, nullptr); }

PolygonMesh read_obj_polygons(std::string_view file) {
  PolygonMesh polygons;
  parse(file, &polygons);
  return polygons;
}

}  // namespace etendue
