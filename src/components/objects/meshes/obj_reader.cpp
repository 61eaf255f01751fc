// Wavefront OBJ files: v, vt, vn and f. Of materials the names are kept, to tell that they are not read;
// everything else (groups, curves) says nothing about triangles.

#include <charconv>
#include <cstring>

#include "etendue/core/error.h"
#include "geometry/own_centre.h"
#include "mesh_data.h"
#include "polygon_mesh.h"

namespace etendue {
namespace {

/// The lines of a text; a backslash at a line's end continues it.
class Lines {
 public:
  explicit Lines(std::string_view file) : at_(file.data()), end_(file.data() + file.size()) {}

  bool next() {
    if (at_ >= end_) return false;
    number_ += 1 + continued_;
    continued_ = 0;
    begin_ = at_;
    for (;;) {
      const char* stop = static_cast<const char*>(std::memchr(at_, '\n', size_t(end_ - at_)));
      line_end_ = stop ? stop : end_;
      at_ = stop ? stop + 1 : end_;
      const char* last = line_end_ > begin_ && line_end_[-1] == '\r' ? line_end_ - 1 : line_end_;
      if (!stop || last == begin_ || last[-1] != '\\') break;
      ++continued_;
    }
    cursor_ = begin_;
    skip_space();
    return true;
  }

  /// The line's first word.
  std::string_view keyword() {
    const char* from = cursor_;
    while (cursor_ < line_end_ && !space(*cursor_)) ++cursor_;
    return {from, size_t(cursor_ - from)};
  }
  bool at_end() {
    skip_space();
    return cursor_ >= line_end_ || *cursor_ == '#';
  }
  template <class Number = float>
  Number number() {
    if (at_end()) error("a number is missing");
    if (*cursor_ == '+') ++cursor_;
    Number value = 0;
    const auto [stop, code] = std::from_chars(cursor_, line_end_, value);
    if (code == std::errc::invalid_argument) error("a number is expected");
    // Too large or too small for a float: the former makes its triangles unusable, the latter is zero.
    if (code == std::errc::result_out_of_range) {
      double wide = 0;
      std::from_chars(cursor_, stop, wide);
      value = Number(wide);
    }
    cursor_ = stop;
    return value;
  }
  std::int64_t integer() {
    std::int64_t value = 0;
    const auto [stop, code] = std::from_chars(cursor_, line_end_, value);
    if (code == std::errc::invalid_argument) error("an index is expected");
    if (code == std::errc::result_out_of_range) value = std::numeric_limits<std::int64_t>::max();
    cursor_ = stop;
    return value;
  }
  bool take(char c) {
    if (cursor_ >= line_end_ || *cursor_ != c) return false;
    ++cursor_;
    return true;
  }
  /// What is left of the line.
  std::string_view rest() {
    if (at_end()) return {};
    const char* last = line_end_;
    while (last > cursor_ && space(last[-1])) --last;
    return {cursor_, size_t(last - cursor_)};
  }
  bool word_ends() const { return cursor_ >= line_end_ || space(*cursor_); }

  [[noreturn]] void error(const std::string& message) const { throw Error("line " + std::to_string(number_) + ": " + message); }

 private:
  static bool space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\\'; }
  void skip_space() {
    while (cursor_ < line_end_ && space(*cursor_)) ++cursor_;
  }

  const char *at_, *end_, *begin_ = nullptr, *line_end_ = nullptr, *cursor_ = nullptr;
  std::int64_t number_ = 0, continued_ = 0;
};

/// More names of materials than this nobody is told.
constexpr size_t most_materials = 100;

struct Counts {
  size_t positions = 0, uvs = 0, normals = 0, faces = 0;
};

/// A first pass, so that indices can be checked at once and nothing grows.
Counts count(std::string_view file) {
  Counts c;
  for (Lines lines(file); lines.next();) {
    const std::string_view word = lines.keyword();
    if (word == "v") ++c.positions;
    if (word == "vt") ++c.uvs;
    if (word == "vn") ++c.normals;
    if (word == "f") ++c.faces;
  }
  return c;
}

/// Vertices by (position, uv, normal): those of one position form a chain, mostly of length one.
class Vertices {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;
  explicit Vertices(size_t positions) : first_(positions, none) {}

  std::uint32_t find(std::uint32_t position, std::uint32_t uv, std::uint32_t normal) {
    for (std::uint32_t i = first_[position]; i != none; i = corners_[i].next)
      if (corners_[i].uv == uv && corners_[i].normal == normal) return i;
    corners_.push_back({position, uv, normal, first_[position]});
    return first_[position] = std::uint32_t(corners_.size() - 1);
  }

  struct Corner {
    std::uint32_t position, uv, normal, next;
  };
  const std::vector<Corner>& corners() const { return corners_; }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<Corner> corners_;
};

std::uint32_t read_index(Lines& lines, size_t so_far, size_t all, const char* what) {
  const std::int64_t given = lines.integer();
  const std::int64_t index = given < 0 ? std::int64_t(so_far) + given : given - 1;
  if (given == 0) lines.error(std::string("the index of a ") + what + " is 0; they count from 1");
  if (index < 0 || index >= std::int64_t(all))
    lines.error(std::string("refers to ") + what + " " + std::to_string(given) + " of " +
                std::to_string(given < 0 ? so_far : all));
  return std::uint32_t(index);
}

/// Corners that are numbered by vertex get their position and their uv. One without uv gets the origin.
void name_corners(const std::vector<Vertices::Corner>& list, PolygonMesh& mesh) {
  if (!mesh.uvs.empty()) {
    const auto origin = std::uint32_t(mesh.uvs.size());
    mesh.uvs.push_back({});
    mesh.uv_corners.reserve(mesh.corners.size());
    for (const std::uint32_t c : mesh.corners) mesh.uv_corners.push_back(list[c].uv == Vertices::none ? origin : list[c].uv);
  }
  for (std::uint32_t& c : mesh.corners) c = list[c].position;
}

/// With `polygons` given, faces go there as they are, and no triangles are made.
DoublePoint3 read_place(Lines& lines) {
  const double x = lines.number<double>(), y = lines.number<double>(), z = lines.number<double>();
  return {x, y, z};
}

/// What the places in a file are to be counted from, which takes a look at all of them when the first is far from the origin.
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
  return own_centre(ends);
}

/// One entry for each vertex. A corner without normal gets a zero one, without uv the origin.
MeshData by_vertex(MeshData mesh, const Vertices& vertices) {
  MeshData result;
  result.centre = mesh.centre;
  const auto& list = vertices.corners();
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
  if (any_normal) {
    result.normals.reserve(list.size());
    for (const auto& c : list) result.normals.push_back(c.normal == Vertices::none ? Normal3{} : mesh.normals[c.normal]);
  }
  result.triangles = std::move(mesh.triangles);
  result.materials = std::move(mesh.materials);
  return result;
}

/// A corner of a face: "p", "p/t", "p//n" or "p/t/n".
struct Corner {
  std::uint32_t position = 0, uv = Vertices::none, normal = Vertices::none;
};
Corner read_corner(Lines& lines, const MeshData& so_far, const Counts& all) {
  Corner c;
  c.position = read_index(lines, so_far.positions.size(), all.positions, "vertex");
  if (lines.take('/') && !lines.word_ends()) {
    if (!lines.take('/')) {
      c.uv = read_index(lines, so_far.uvs.size(), all.uvs, "texture coordinate");
      if (lines.take('/') && !lines.word_ends()) c.normal = read_index(lines, so_far.normals.size(), all.normals, "normal");
    } else if (!lines.word_ends()) {
      c.normal = read_index(lines, so_far.normals.size(), all.normals, "normal");
    }
  }
  if (!lines.word_ends()) lines.error("an index is expected");
  return c;
}

struct Face {
  std::vector<std::uint32_t> corners, positions;
};

/// Cuts faces into triangles: by positions, then named by vertices.
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
  }

 private:
  MeshData face_;
  std::vector<std::uint32_t> order_;
};

MeshData parse(std::string_view file, PolygonMesh* polygons) {
  const Counts all = count(file);
  if (all.positions == 0) throw Error("it has no vertices");
  if (all.faces == 0) throw Error("it has no faces");
  if (all.positions >= Vertices::none || all.uvs >= Vertices::none || all.normals >= Vertices::none)
    throw Error("more than 2^32 vertices");
  const bool plain = all.uvs == 0 && all.normals == 0;

  MeshData mesh;  // as in the file until all is read
  mesh.centre = centre_of(file);
  mesh.positions.reserve(all.positions + 1);  // one more, for the padding the object adds
  mesh.uvs.reserve(all.uvs);
  mesh.normals.reserve(all.normals);
  mesh.triangles.reserve(all.faces);
  Vertices vertices(plain ? 0 : all.positions);
  std::vector<std::uint32_t> corners, positions;
  std::vector<Face> late;  // faces that stand before their vertices and have more than three corners
  FaceCutter cutter;
  std::vector<std::string> materials;
  for (Lines lines(file); lines.next();) {
    const std::string_view word = lines.keyword();
    if (word == "v") {
      mesh.positions.push_back(Point3(DoublePoint3{} + (read_place(lines) - mesh.centre)));
    } else if (word == "vt") {
      const float u = lines.number();
      mesh.uvs.push_back({u, lines.at_end() ? 0 : lines.number()});
    } else if (word == "vn") {
      const float x = lines.number(), y = lines.number(), z = lines.number();
      mesh.normals.push_back({x, y, z});
    } else if (word == "usemtl") {
      const std::string name(lines.rest());
      if (std::find(materials.begin(), materials.end(), name) == materials.end() && materials.size() < most_materials)
        materials.push_back(name);
    } else if (word == "f") {
      corners.clear();
      positions.clear();
      bool known = true;
      while (!lines.at_end()) {
        const Corner c = read_corner(lines, mesh, all);
        known = known && c.position < mesh.positions.size();
        positions.push_back(c.position);
        corners.push_back(plain ? c.position : vertices.find(c.position, c.uv, c.normal));
      }
      if (corners.size() < 3) lines.error("a face needs at least three vertices");
      if (polygons) {
        polygons->face_sizes.push_back(std::uint32_t(corners.size()));
        polygons->corners.insert(polygons->corners.end(), corners.begin(), corners.end());
      } else if (corners.size() == 3) {
        mesh.triangles.push_back({corners[0], corners[1], corners[2]});
      } else if (!known) {
        late.push_back({corners, positions});
      } else {
        cutter.cut({corners, positions}, mesh);
      }
    }
  }
  if (polygons) {
    polygons->positions = std::move(mesh.positions);
    polygons->centre = mesh.centre;
    polygons->uvs = std::move(mesh.uvs);
    if (!plain) name_corners(vertices.corners(), *polygons);
    return mesh;
  }
  for (const Face& polygon : late) cutter.cut(polygon, mesh);
  mesh.materials = materials;
  if (plain) return mesh;

  return by_vertex(std::move(mesh), vertices);
}

}  // namespace

MeshData read_obj(std::string_view file) { return parse(file, nullptr); }

PolygonMesh read_obj_polygons(std::string_view file) {
  PolygonMesh polygons;
  parse(file, &polygons);
  return polygons;
}

}  // namespace etendue
