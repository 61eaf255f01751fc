#include "polygon_mesh.h"

#include <algorithm>

#include "etendue/describe/component.h"
#include "files/regular_file.h"
#include "geometry/point_groups.h"

namespace etendue {
namespace {

bool usable(const Point3& p) {
  constexpr float largest = 1e18f;  // squares of coordinates must stay finite
  return std::abs(p.x) < largest && std::abs(p.y) < largest && std::abs(p.z) < largest;  // false for NaN
}

/// Keeps only the values with the indices `kept`, in that order.
template <class T>
void compact(std::vector<T>& values, const std::vector<std::uint32_t>& kept, size_t width = 1) {
  std::vector<T> out;
  out.reserve(kept.size() * width);
  for (const std::uint32_t k : kept)
    out.insert(out.end(), values.begin() + std::ptrdiff_t(k * width), values.begin() + std::ptrdiff_t((k + 1) * width));
  values = std::move(out);
}

}  // namespace

PolygonMesh read_polygon_mesh(const std::string& path) {
  try {
    const FileContents file(path);
    const std::string_view text = file.text();
    if (text.empty()) throw Error("the file is empty");
    if (text.starts_with("ply\n") || text.starts_with("ply\r")) return read_ply_polygons(text);
    std::string ending = path.substr(std::min(path.size(), path.find_last_of('.') + 1));
    for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
    if (ending == "ply") return read_ply_polygons(text);
    if (ending == "obj") return read_obj_polygons(text);
    throw Error("this is no mesh format that is known here (PLY and OBJ are)");
  } catch (const Error& error) {
    throw Error("'" + path + "': " + error.what());
  } catch (const std::bad_alloc&) {
    throw Error("'" + path + "': " + no_memory_to_read);
  }
}

TidiedVertices tidy(PolygonMesh& mesh, bool weld, const std::string& whose) {
  TidiedVertices result;
  const size_t count = mesh.positions.size();
  std::vector<std::uint32_t> place(count);
  if (weld)
    place = first_in_place(mesh.positions);
  else
    for (std::uint32_t i = 0; i < count; ++i) place[i] = i;

  if (weld && !mesh.uvs.empty()) {  // so that corners of one vertex have different uv indices only at seams
    std::vector<Point3> flat;
    flat.reserve(mesh.uvs.size());
    for (const Point2& uv : mesh.uvs) flat.push_back({uv.x, uv.y, 0});
    const std::vector<std::uint32_t> first = first_in_place(flat);
    for (std::uint32_t& c : mesh.uv_corners) c = first[c];
  }

  std::vector<bool> used(count);
  size_t from = 0, to = 0, faces = 0, unsound = 0;
  const bool uvs = !mesh.uv_corners.empty();
  std::vector<std::uint32_t> face, sorted;
  for (const std::uint32_t size : mesh.face_sizes) {
    // Consecutive corners that have been welded are merged.
    const size_t begin = to;
    for (size_t i = from; i < from + size; ++i) {
      const std::uint32_t v = place[mesh.corners[i]];
      if (to > begin && mesh.corners[to - 1] == v) continue;
      mesh.corners[to] = v;
      if (uvs) mesh.uv_corners[to] = mesh.uv_corners[i];
      ++to;
    }
    if (to > begin + 1 && mesh.corners[to - 1] == mesh.corners[begin]) --to;
    from += size;
    sorted.assign(mesh.corners.begin() + std::ptrdiff_t(begin), mesh.corners.begin() + std::ptrdiff_t(to));
    std::sort(sorted.begin(), sorted.end());
    const bool sound = sorted.size() >= 3 && std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end() &&
                       std::all_of(sorted.begin(), sorted.end(), [&](std::uint32_t v) { return usable(mesh.positions[v]); });
    if (!sound) {
      ++unsound;
      to = begin;
      continue;
    }
    for (const std::uint32_t v : sorted) used[v] = true;
    mesh.face_sizes[faces++] = std::uint32_t(to - begin);
  }
  if (faces == 0) throw Error(whose + ": none of its " + std::to_string(mesh.face_sizes.size()) + " faces can be used");
  if (unsound > 0)
    warn(whose + ": left out " + std::to_string(unsound) +
         " faces with fewer than three corners, a corner twice or one that is not finite");
  mesh.face_sizes.resize(faces);
  mesh.corners.resize(to);
  if (uvs) mesh.uv_corners.resize(to);

  std::vector<std::uint32_t> kept, number(count, PolygonMesh::none);
  for (std::uint32_t i = 0; i < count; ++i)
    if (used[i]) {
      number[i] = std::uint32_t(kept.size());
      kept.push_back(i);
    }
  compact(mesh.positions, kept);
  for (VertexAttribute& a : mesh.attributes) compact(a.values, kept, size_t(a.width));
  for (std::uint32_t& c : mesh.corners) c = number[c];
  result.now.resize(count);
  for (size_t i = 0; i < count; ++i) result.now[i] = number[place[i]];
  return result;
}

}  // namespace etendue
