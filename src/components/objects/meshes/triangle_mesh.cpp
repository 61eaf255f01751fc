// TriangleMesh: triangles from a file or a list; may be deformed over time.

#include "etendue/describe/read_ahead.h"
#include "geometry/inner_origin.h"
#include "geometry/triangle_test.h"
#include "geometry/usable_triangles.h"
#include "mesh_files.h"
#include "triangle_object.h"

namespace etendue {
namespace {

/// Appends vertex normals, the area-weighted means over the adjacent triangles; edges between separate vertices stay sharp.
void append_normals(std::span<const Point3> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                    std::vector<Normal3>& to) {
  std::vector<Vector3> sums(positions.size());
  for (const auto& t : triangles)
    for (const std::uint32_t c : t) sums[c] += area_vector(positions[t[0]], positions[t[1]], positions[t[2]]);
  for (const Vector3& n : sums) {
    const float l = length(n);
    to.push_back(l > 0 && l < infinity ? Normal3(n / l) : Normal3{});
  }
}

}  // namespace

class TriangleMesh final : public TriangleObject, public ReadsAhead {
  FilePath file;
  std::string part;
  std::vector<DoublePoint3> positions;
  std::vector<std::uint32_t> triangles;
  std::vector<Normal3> normals;
  std::vector<Point2> uvs;
  std::vector<Vector3> colors, face_colors;
  bool flat = false, smooth = false;
  std::vector<float> times;
  std::vector<FilePath> motion_files;
  std::vector<DoublePoint3> motion_positions;
  std::vector<Normal3> motion_normals;

 public:
  static void describe(Description<TriangleMesh>& d) {
    d.summary(
         "Triangles, from a file or written out. Meshes from one file share it. A mesh that changes its shape has several "
         "keys: at each of `times` the vertices are where one of them says, and between two they move in straight lines.")
        .group("Shape")
        .member<&TriangleMesh::file>("file", "", "a PLY, OBJ, STL or OFF file, or a model with parts; none: the lists below",
                                     Effect::rebuild)
        .member<&TriangleMesh::part>("part", "",
                                     "which mesh of a file that has several: of glTF \"meshes[0].primitives[1]\", of OBJ the "
                                     "faces of a material, \"usemtl brass\", of Mitsuba's serialized meshes the number, \"0\"",
                                     Effect::rebuild)
        .member<&TriangleMesh::positions>("positions", "m", "the vertices, when there is no file", Effect::rebuild)
        .member<&TriangleMesh::triangles>(
            "triangles", "1", "three vertices, counting from 0, for each triangle; counter-clockwise seen from the front",
            Effect::rebuild)
        .member<&TriangleMesh::normals>("normals", "1", "a normal for each vertex, or none", Effect::rebuild)
        .member<&TriangleMesh::uvs>("uvs", "1", "surface coordinates for each vertex; none: those within each triangle",
                                    Effect::rebuild)
        .member<&TriangleMesh::colors>("colors", "1",
                                       "red, green and blue (linear, of sRGB) for each vertex, or none; for "
                                       "AttributeMap, as are those of a PLY file",
                                       Effect::rebuild)
        .member<&TriangleMesh::face_colors>(
            "face_colors", "1", "likewise for each triangle, or none; for AttributeMap as \"face_color\"", Effect::rebuild)
        .member<&TriangleMesh::flat>("flat", "", "ignores normals of vertices: the surface is shaded as it is", Effect::rebuild)
        .member<&TriangleMesh::smooth>("smooth", "",
                                       "gives a mesh without normals those of the triangles around each vertex, so that it "
                                       "looks round",
                                       Effect::rebuild)
        .group("Motion")
        .member<&TriangleMesh::times>("times", "s", "of the keys, increasing: the first is that of `file` or `positions`",
                                      Effect::rebuild)
        .member<&TriangleMesh::motion_files>(
            "motion_files", "", "for each later key a file with the same vertices in other places", Effect::rebuild)
        .member<&TriangleMesh::motion_positions>(
            "motion_positions", "m", "without files: the vertices at the second key, then those at the third, and so on",
            Effect::rebuild)
        .member<&TriangleMesh::motion_normals>(
            "motion_normals", "1", "likewise the normals; none: found from the triangles, if the first key has normals",
            Effect::rebuild);
  }

  void read_ahead() override {
    if (!file.empty()) ahead_ = mesh_from_file(file.resolved(), part, moves());
  }

  void prepare() override {
    try {
      prepare_triangles();
    } catch (const NoTriangles& nothing) {
      if (file.empty())
        throw;  // the author of the scene is not responsible for a file's contents: one of many meshes may be
                // degenerate
      warn(std::string(nothing.what()) + ": it is left out", nothing.location);
      auto none = std::make_shared<MeshData>();
      make_shareable(*none);
      attributes_.clear();
      ahead_ = nullptr;
      adopt(std::move(none));
    }
  }

  int attribute(int number, const SurfacePoint& p, float* values) const override {
    for (const Attribute& a : attributes_) {
      if (a.number != number) continue;
      if (a.of_faces) {
        std::copy_n(a.values + size_t(p.primitive) * size_t(a.width), a.width, values);
        return a.width;
      }
      const auto& t = corner_indices(p.primitive);
      const size_t width = size_t(a.width);
      const float *v0 = &a.values[t[0] * width], *v1 = &a.values[t[1] * width], *v2 = &a.values[t[2] * width];
      for (size_t i = 0; i < width; ++i) values[i] = (1 - p.u - p.v) * v0[i] + p.u * v1[i] + p.v * v2[i];
      return a.width;
    }
    return 0;
  }

 private:
  void prepare_triangles() {
    std::shared_ptr<const MeshData> mesh;
    if (!file.empty()) {
      if (!positions.empty() || !triangles.empty() || !normals.empty() || !uvs.empty() || !colors.empty() ||
          !face_colors.empty())
        fail("file", "a mesh comes from a file or from lists, not from both");
      mesh = from_file("file", file, moves());
    } else {
      if (!part.empty()) fail("part", "a part is that of a file, and there is none");
      MeshData own = listed();
      if (!moves()) drop(own);
      make_shareable(own);
      mesh = std::make_shared<const MeshData>(std::move(own));
    }
    if (smooth && !flat && mesh->normals.empty() && !mesh->faceted) {
      auto round = std::make_shared<MeshData>(*mesh);
      smooth_normals(*round);
      round->normals.pop_back();  // the normal of the padding vertex
      mesh = std::move(round);
    }
    MeshMotion motion = keyed(mesh);
    if (flat && !mesh->normals.empty()) {
      auto bare = std::make_shared<MeshData>(*mesh);
      bare->normals = {};
      mesh = std::move(bare);
      motion.normals = {};
    }
    if (!file.empty() && part.empty()) warn_if_coarse(*mesh);
    attributes_.clear();
    for (const VertexAttribute& a : mesh->attributes)
      attributes_.push_back({attribute_number(a.name), a.width, a.values.data(), false});
    for (const VertexAttribute& a : mesh->face_attributes)
      attributes_.push_back({attribute_number(a.name), a.width, a.values.data(), true});
    ahead_ = nullptr;
    adopt(std::move(mesh), std::move(motion));
  }

  /// Throws NoTriangles with the message and location that fail() would give.
  [[noreturn]] void refuse(const char* member, const NoTriangles& nothing) const {
    try {
      fail(member, nothing.what());
    } catch (const Error& located) {
      throw NoTriangles(located.what(), located.location);
    }
  }

  struct Attribute {
    int number;  // see attribute_number
    int width;
    const float* values;  // points into the adopted mesh
    bool of_faces;
  };

  std::shared_ptr<const MeshData> from_file(const char* member, const FilePath& path, bool whole) const {
    try {
      return mesh_from_file(path.resolved(), part, whole);
    } catch (const NoTriangles& nothing) {
      refuse(member, nothing);
    } catch (const Error& error) {
      fail(member, error.what());
    }
  }
  bool moves() const { return !motion_files.empty() || !motion_positions.empty(); }

  /// Removes unusable triangles; `later` holds the positions at all keys but the first.
  void drop(MeshData& mesh, std::span<const Point3> later = {}) const {
    const std::string own_name = origin && !origin->name.empty() ? origin->name : "TriangleMesh";
    try {
      drop_unusable(mesh, file.empty() ? own_name : "'" + file.resolved() + "'", later);
    } catch (const NoTriangles& nothing) {
      refuse(file.empty() ? "positions" : "file", nothing);
    }
  }

  /// The positions and normals at all keys; the mesh has those of the first. From a deforming mesh, triangles that are unusable
  /// at all keys are removed.
  MeshMotion keyed(std::shared_ptr<const MeshData>& mesh) const {
    MeshMotion motion;
    const bool from_lists = !motion_positions.empty();
    if (!from_lists && motion_files.empty()) {
      if (!times.empty()) fail("times", "there are no later keys: motion_files or motion_positions");
      if (!motion_normals.empty()) fail("motion_normals", "there are no motion_positions they belong to");
      return motion;
    }
    if (from_lists && !motion_files.empty()) fail("motion_files", "later keys come from files or from lists, not from both");
    const size_t n = mesh->positions.size() - 1;
    if (n == 0) fail("file", "a mesh without vertices has no later keys");
    if (motion_positions.size() % n != 0)
      fail("motion_positions", std::to_string(motion_positions.size()) + " positions are no multiple of the mesh's " +
                                   std::to_string(n) + " vertices");
    const size_t later = from_lists ? motion_positions.size() / n : motion_files.size();
    if (times.size() != later + 1)
      fail("times", std::to_string(times.size()) + " times for " + std::to_string(later + 1) + " keys (the first is the mesh)");
    for (size_t i = 0; i < times.size(); ++i) {
      if (!std::isfinite(times[i])) fail("times", "the times of keys must be finite");
      if (i > 0 && !(times[i - 1] < times[i])) fail("times", "the times of keys must increase");
    }
    if (!motion_normals.empty() && motion_normals.size() != motion_positions.size())
      fail("motion_normals",
           std::to_string(motion_normals.size()) + " normals for " + std::to_string(motion_positions.size()) + " positions");

    motion.times = times;
    motion.positions.reserve(n * times.size() + 1);
    motion.positions.assign(mesh->positions.begin(), mesh->positions.end() - 1);
    motion.normals = mesh->normals;
    bool normals_known = from_lists ? !motion_normals.empty() : true;
    if (from_lists) {
      const std::vector<Point3> later_positions = relative_to(mesh->centre, motion_positions);
      motion.positions.insert(motion.positions.end(), later_positions.begin(), later_positions.end());
      for (const Normal3& normal : motion_normals) {
        const float l = length(Vector3(normal));
        motion.normals.push_back(l > 0 && l < infinity ? Normal3(Vector3(normal) / l) : Normal3{});
      }
    }
    for (const FilePath& path : motion_files) {
      const std::shared_ptr<const MeshData> key = from_file("motion_files", path, true);
      if (key->positions.size() != n + 1)
        fail("motion_files", "'" + path.resolved() + "' has " + std::to_string(key->positions.size() - 1) +
                                 " vertices, the first key " + std::to_string(n));
      const DoubleVector3 between = key->centre - mesh->centre;
      for (size_t i = 0; i < n; ++i) motion.positions.push_back(Point3(DoublePoint3(key->positions[i]) + between));
      motion.normals.insert(motion.normals.end(), key->normals.begin(), key->normals.end());
      normals_known = normals_known && !key->normals.empty();
    }
    auto kept = std::make_shared<MeshData>(*mesh);
    kept->positions.pop_back();
    drop(*kept, std::span(motion.positions).subspan(n));
    kept->positions.push_back({});
    if (kept->triangles.size() < mesh->triangles.size()) mesh = std::move(kept);
    constexpr float largest = 1e18f;  // as for all meshes
    for (const auto& t : mesh->triangles)
      for (const std::uint32_t c : t)
        for (size_t k = n; k < motion.positions.size(); k += n) {
          const Point3& p = motion.positions[k + c];
          if (!(std::abs(p.x) < largest && std::abs(p.y) < largest && std::abs(p.z) < largest))
            fail(from_lists ? "motion_positions" : "motion_files",
                 "vertex " + std::to_string(c) + " of key " + std::to_string(k / n + 1) + " is not finite");
        }
    if (mesh->normals.empty()) {
      motion.normals = {};
    } else if (!normals_known) {
      motion.normals = {};
      for (size_t k = 0; k < motion.positions.size(); k += n)
        append_normals({&motion.positions[k], n}, mesh->triangles, motion.normals);
    }
    motion.positions.push_back({});
    return motion;
  }

  /// Warns if the file's float coordinates are too coarse for its triangles.
  void warn_if_coarse(const MeshData& mesh) const {
    double sum = 0;
    float away = 0;
    for (const auto& t : mesh.triangles) {
      sum += double(length(area_vector(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]])));
      away = std::max(away, max_component(abs(mesh.positions[t[0]] - Point3{})));
    }
    const double edge = std::sqrt(sum / double(std::max<size_t>(mesh.triangles.size(), 1))),
                 step = double(rounding_bound(2) * away);
    if (edge < 32 * step)
      warn(fmt::format(
               "'{}': its triangles are about {:.2g} m large, but its vertices lie {:.3g} m from the origin, where floats "
               "are {:.2g} m apart: their shape is spoilt. Write the vertices as doubles, or relative to their middle, "
               "and move the mesh by its transform",
               file.resolved(), edge, away, step),
           location_of("file"));
  }

  MeshData listed() const {
    const size_t n = positions.size();
    if (n == 0) fail("", "a mesh needs either a file or positions and triangles");
    if (triangles.empty()) fail("triangles", "there are positions but no triangles");
    if (triangles.size() % 3 != 0)
      fail("triangles", "three indices make a triangle, but " + std::to_string(triangles.size()) + " are given");
    if (!normals.empty() && normals.size() != n)
      fail("normals", std::to_string(normals.size()) + " normals for " + std::to_string(n) + " positions");
    if (!uvs.empty() && uvs.size() != n)
      fail("uvs", std::to_string(uvs.size()) + " surface coordinates for " + std::to_string(n) + " positions");
    if (!colors.empty() && colors.size() != n)
      fail("colors", std::to_string(colors.size()) + " colours for " + std::to_string(n) + " positions");
    MeshData mesh;
    mesh.centre = inner_origin_for(positions);
    mesh.positions = relative_to(mesh.centre, positions);
    mesh.normals = normals;
    mesh.uvs = uvs;
    if (!colors.empty()) {
      VertexAttribute& color = mesh.attributes.emplace_back(VertexAttribute{"color", 3, {}});
      color.values.reserve(3 * n);
      for (const Vector3& c : colors) color.values.insert(color.values.end(), {c.x, c.y, c.z});
    }
    if (!face_colors.empty()) {
      if (face_colors.size() != triangles.size() / 3)
        fail("face_colors",
             std::to_string(face_colors.size()) + " colours for " + std::to_string(triangles.size() / 3) + " triangles");
      VertexAttribute& color = mesh.face_attributes.emplace_back(VertexAttribute{"face_color", 3, {}});
      for (const Vector3& c : face_colors) color.values.insert(color.values.end(), {c.x, c.y, c.z});
    }
    mesh.triangles.reserve(triangles.size() / 3);
    for (size_t i = 0; i < triangles.size(); i += 3) {
      for (size_t k = i; k < i + 3; ++k)
        if (triangles[k] >= n)
          fail("triangles", "triangle " + std::to_string(i / 3) + " refers to vertex " + std::to_string(triangles[k]) + " of " +
                                std::to_string(n) + " (counting from 0)");
      mesh.triangles.push_back({triangles[i], triangles[i + 1], triangles[i + 2]});
    }
    return mesh;
  }

  std::shared_ptr<const MeshData> ahead_;
  std::vector<Attribute> attributes_;
};

static const Register<TriangleMesh> registered;

}  // namespace etendue
