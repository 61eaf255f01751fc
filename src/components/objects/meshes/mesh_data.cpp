// Functions common to all mesh formats.

#include "mesh_data.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "etendue/describe/component.h"
#include "files/file_kind.h"
#include "files/format_library.h"
#include "files/gzip.h"
#include "files/regular_file.h"
#include "files/text_encoding.h"
#include "geometry/usable_triangles.h"
#include "polygon_triangulation.h"

namespace etendue {

namespace {

std::map<std::string, ReadPart>& formats() {
  static auto* all = new std::map<std::string, ReadPart>;
  return *all;
}

/// The formats that are read here, by their endings. OBJ is registered too, for files with parts.
constexpr std::pair<std::string_view, MeshData (*)(std::string_view)> own_formats[] = {
    {"ply", read_ply}, {"obj", read_obj}, {"stl", read_stl}, {"off", read_off}};

/// Null: the format is not read here.
auto own_format(std::string_view ending) {
  const auto known = std::ranges::find(own_formats, ending, [](const auto& format) { return format.first; });
  return known == std::end(own_formats) ? nullptr : known->second;
}

MeshData read_text(const std::string& path, const std::string& ending) {
  const FileContents file(path);
  const bool marked = has_byte_order_mark(file.text());
  const std::string plain = marked ? as_utf8(file.text()) : std::string();
  const std::string_view text = marked ? plain : file.text();
  if (text.empty()) throw Error("the file is empty");
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return read_ply(text);
  if (const auto read = own_format(ending)) return read(text);
  throw Error("this is no mesh format that is known here (PLY, OBJ, STL and OFF are, and those of importers)");
}

MeshData read_whole(const std::string& path, const std::string& ending) {
  MeshData mesh = read_text(path, ending);
  tell_remarks(mesh, path);
  return mesh;
}

}  // namespace

void replace_infinite_colors(std::span<float> colors, MeshData& mesh) {
  bool found = false;
  for (size_t i = 0; i + 3 <= colors.size(); i += 3) {
    const std::span<float> color = colors.subspan(i, 3);
    if (std::ranges::all_of(color, [](float x) { return std::isfinite(x); })) continue;
    std::ranges::fill(color, 1.0f);
    found = true;
  }
  const std::string remark = "colours that are not finite numbers are white";
  if (found && std::ranges::find(mesh.remarks, remark) == mesh.remarks.end()) mesh.remarks.push_back(remark);
}

void tell_remarks(const MeshData& mesh, const std::string& path) {
  for (const std::string& remark : mesh.remarks) warn("'" + path + "': " + remark);
}

bool register_mesh_format(const std::vector<std::string>& endings, ReadPart read) {
  const std::lock_guard lock(libraries_guard());
  for (const std::string& ending : endings) formats()[ending] = read;
  return true;
}

namespace {

/// Null: no format that importers or other files here registered.
ReadPart registered_format(const std::string& ending) {
  const std::lock_guard lock(libraries_guard());
  auto known = formats().find(ending);
  if (known == formats().end() && !own_format(ending) && load_format_library()) known = formats().find(ending);
  return known == formats().end() ? nullptr : known->second;
}

}  // namespace

MeshData read_mesh(const std::string& path, const std::string& part) {
  try {
    const std::string ending = ending_of_contents(path);
    const ReadPart other = registered_format(ending);
    if (other && (!part.empty() || ending != "obj")) return other(path, part);
    if (!part.empty()) throw Error("files of this format have no parts");
    return read_whole(path, ending);
  } catch (const NoTriangles& error) {
    throw NoTriangles("'" + path + "': " + error.what());
  } catch (const Error& error) {
    const std::string mistaken = mistaken_contents(path);
    throw Error("'" + path + "': " + (mistaken.empty() ? std::string(error.what()) : mistaken));
  } catch (const std::bad_alloc&) {
    throw Error("'" + path + "': " + no_memory_to_read);
  }
}

void smooth_normals(MeshData& mesh) {
  std::vector<Vector3> sums(mesh.positions.size());
  for (const auto& t : mesh.triangles) {
    const Point3 corner[3] = {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    const Vector3 across = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const float area = length(across);
    if (!(area > 0 && area < infinity)) continue;
    for (int i = 0; i < 3; ++i) {
      const Vector3 a = corner[(i + 1) % 3] - corner[i], b = corner[(i + 2) % 3] - corner[i];
      sums[t[size_t(i)]] += std::atan2(length(cross(a, b)), dot(a, b)) / area * across;
    }
  }
  mesh.normals.clear();
  mesh.normals.reserve(sums.size());
  for (const Vector3& n : sums) {
    const float l = length(n);
    mesh.normals.push_back(l > 0 && l < infinity ? Normal3(n / l) : Normal3{});
  }
}

void drop_unusable(MeshData& mesh, const std::string& whose, std::span<const Point3> later, bool counted) {
  size_t kept = 0, not_finite = 0, without_area = 0;
  const size_t vertices = mesh.positions.size();
  for (const auto& t : mesh.triangles) {
    const Point3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    if (!countable(a) || !countable(b) || !countable(c)) {
      ++not_finite;
      continue;
    }
    bool flat = without_height(a, b, c);
    for (size_t k = 0; flat && k < later.size(); k += vertices)
      flat = without_height(later[k + t[0]], later[k + t[1]], later[k + t[2]]);
    if (flat) {
      ++without_area;
      continue;
    }
    for (VertexAttribute& f : mesh.face_attributes)
      std::copy_n(f.values.begin() + (&t - mesh.triangles.data()) * f.width, f.width,
                  f.values.begin() + std::ptrdiff_t(kept) * f.width);
    mesh.triangles[kept++] = t;
  }
  if (kept == 0 && !mesh.triangles.empty())
    throw NoTriangles(whose + ": none of its " + std::to_string(mesh.triangles.size()) + " triangles can be used (" +
                      std::to_string(not_finite) + " with coordinates that are not finite, " + std::to_string(without_area) +
                      " without area)");
  mesh.triangles.resize(kept);
  for (VertexAttribute& a : mesh.face_attributes) a.values.resize(kept * size_t(a.width));
  const auto tell = [&](size_t count, const char* which) {
    if (count > 0) warn(whose + ": left out " + (counted ? std::to_string(count) + " triangles " : "triangles ") + which);
  };
  tell(not_finite, "with coordinates that are not finite");
  tell(without_area, "without area");
}

namespace {

/// The corner of a convex polygon from which a fan has no degenerate triangle, if there is one. A polygon may have collinear
/// corners (T-vertices of neighbouring faces); if the triangle at such a corner were degenerate and removed, a closed surface
/// would have a gap there.
size_t fan_apex(const std::vector<Point3>& points, const Vector3& normal) {
  const size_t count = points.size();
  const float least = 1e-6f * dot(normal, normal);
  for (size_t a = 0; a < count; ++a) {
    bool all = true;
    for (size_t i = 2; i < count && all; ++i)
      all = dot(cross(points[(a + i - 1) % count] - points[a], points[(a + i) % count] - points[a]), normal) > least;
    if (all) return a;
  }
  return 0;
}

}  // namespace

void append_polygon(MeshData& mesh, const std::uint32_t* corners, size_t count) {
  if (count < 3) return;
  if (count == 3) {
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
    return;
  }
  thread_local std::vector<Point3> points;
  thread_local std::vector<std::array<std::uint32_t, 3>> cut;
  points.clear();
  for (size_t i = 0; i < count; ++i) points.push_back(mesh.positions[corners[i]]);
  const Vector3 normal = newell_normal(points);
  bool convex = true;
  for (size_t i = 2; i < count && convex; ++i)
    convex = dot(cross(points[i - 1] - points[0], points[i] - points[0]), normal) >= 0;
  for (size_t i = 0; i < count && convex; ++i) {
    const Point3 &a = points[i], &b = points[(i + 1) % count], &c = points[(i + 2) % count];
    convex = dot(cross(b - a, c - b), normal) >= 0;
  }
  bool sound = is_finite(normal);
  if (convex || !sound || count > 4096) {  // ear clipping takes quadratic time: a malicious file must not block the program
    const size_t a = convex && count <= 64 ? fan_apex(points, normal) : 0;
    for (size_t i = 2; i < count; ++i)
      mesh.triangles.push_back({corners[a], corners[(a + i - 1) % count], corners[(a + i) % count]});
    return;
  }
  cut.clear();
  triangulate(points, cut);
  for (const auto& t : cut) mesh.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
}

}  // namespace etendue
