// TriangleMesh: triangles from a file or a list.

#include "triangle_object.h"

namespace etendue {

class TriangleMesh final : public TriangleObject {
  FilePath file;
  std::vector<Point3> positions;
  std::vector<std::uint32_t> triangles;
  std::vector<Normal3> normals;
  std::vector<Point2> uvs;
  std::vector<Vector3> colors;
  bool flat = false;

 public:
  static void describe(Description<TriangleMesh>& d) {
    d.summary("Triangles, from a file or written out.")
        .member<&TriangleMesh::file>("file", "", "a PLY file (text or binary) or an OBJ file; none: the lists below",
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
        .member<&TriangleMesh::flat>("flat", "", "ignores normals of vertices: the surface is shaded as it is",
                                     Effect::rebuild);
  }

  void prepare() override {
    MeshData mesh;
    if (!file.empty()) {
      if (!positions.empty() || !triangles.empty() || !normals.empty() || !uvs.empty() || !colors.empty())
        fail("file", "a mesh comes from a file or from lists, not from both");
      try {
        mesh = read_mesh(file.resolved());
        drop_unusable(mesh, "'" + file.resolved() + "'");
      } catch (const Error& error) {
        fail("file", error.what());
      }
    } else {
      mesh = listed();
    }
    if (flat) mesh.normals = {};
    attributes_.clear();
    for (VertexAttribute& a : mesh.attributes) attributes_.push_back({attribute_number(a.name), a.width, std::move(a.values)});
    mesh.attributes.clear();
    own_corners_.clear();
    if (!attributes_.empty() && transform.animated()) own_corners_ = mesh.triangles;
    adopt(std::move(mesh));
    const std::optional<TriangleView> view = TriangleObject::triangles();
    corners_ = view ? view->triangles : own_corners_;
  }

  int attribute(int number, const SurfacePoint& p, float* values) const override {
    for (const Attribute& a : attributes_) {
      if (a.number != number) continue;
      const auto& t = corners_[p.primitive];
      const size_t width = size_t(a.width);
      const float *v0 = &a.values[t[0] * width], *v1 = &a.values[t[1] * width], *v2 = &a.values[t[2] * width];
      for (size_t i = 0; i < width; ++i) values[i] = (1 - p.u - p.v) * v0[i] + p.u * v1[i] + p.v * v2[i];
      return a.width;
    }
    return 0;
  }

 private:
  struct Attribute {
    int number;  // see attribute_number
    int width;
    std::vector<float> values;
  };

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
    mesh.positions.reserve(n + 1);
    mesh.positions = positions;
    mesh.normals = normals;
    mesh.uvs = uvs;
    if (!colors.empty()) {
      VertexAttribute& color = mesh.attributes.emplace_back(VertexAttribute{"color", 3, {}});
      color.values.reserve(3 * n);
      for (const Vector3& c : colors) color.values.insert(color.values.end(), {c.x, c.y, c.z});
    }
    mesh.triangles.reserve(triangles.size() / 3);
    for (size_t i = 0; i < triangles.size(); i += 3) {
      for (size_t k = i; k < i + 3; ++k)
        if (triangles[k] >= n)
          fail("triangles", "triangle " + std::to_string(i / 3) + " refers to vertex " + std::to_string(triangles[k]) + " of " +
                                std::to_string(n) + " (counting from 0)");
      mesh.triangles.push_back({triangles[i], triangles[i + 1], triangles[i + 2]});
    }
    try {
      drop_unusable(mesh, origin && !origin->name.empty() ? origin->name : "TriangleMesh");
    } catch (const Error& error) {
      fail("positions", error.what());
    }
    return mesh;
  }

  std::vector<Attribute> attributes_;
  std::span<const std::array<std::uint32_t, 3>> corners_;  // of each triangle; of the attributes nothing is asked without
  std::vector<std::array<std::uint32_t, 3>> own_corners_;  // of a moving mesh
};

static const Register<TriangleMesh> registered;

}  // namespace etendue
