// SubdivisionSurface: the limit surface of a polygon cage.

#include <unordered_set>

#include "components/objects/meshes/triangle_object.h"
#include "components/objects/meshes/vertex_attributes.h"
#include "geometry/inner_origin.h"
#include "subdivision.h"

namespace etendue {
namespace {

class SubdivisionSurface final : public TriangleObject {
 public:
  static void describe(Description<SubdivisionSurface>& d) {
    d.summary(
         "The smooth limit surface of a cage of polygons, as triangles whose corners and normals are those of the limit. The "
         "cage comes from a file or is written out.",
         "Catmull & Clark 1978; Loop 1987; creases: DeRose, Kass & Truong 1998; evaluation: OpenSubdiv")
        .group("Cage")
        .member<&SubdivisionSurface::file>(
            "file", "", "a PLY file (text or binary) or an OBJ file, of which faces stay as they are; none: the lists below",
            Effect::rebuild)
        .member<&SubdivisionSurface::positions>("positions", "m", "the vertices of the cage, when there is no file",
                                                Effect::rebuild)
        .member<&SubdivisionSurface::face_sizes>("face_sizes", "1", "how many corners each face has; none: 4 each (of Loop 3)",
                                                 Effect::rebuild)
        .member<&SubdivisionSurface::indices>(
            "indices", "1",
            "the vertices of each face, counting from 0, face after face; counter-clockwise seen from the front",
            Effect::rebuild)
        .member<&SubdivisionSurface::uvs>("uvs", "1", "surface coordinates: one for each vertex, or as uv_indices says",
                                          Effect::rebuild)
        .member<&SubdivisionSurface::uv_indices>("uv_indices", "1",
                                                 "which of uvs each corner of each face has, as indices does of vertices; an "
                                                 "edge along which they differ is a seam",
                                                 Effect::rebuild)
        .group("Creases")
        .member<&SubdivisionSurface::creases>("creases", "1", "edges that are sharp: two vertices each, counting from 0",
                                              Effect::rebuild)
        .member<&SubdivisionSurface::crease_sharpness>(
            "crease_sharpness", "1",
            "how sharp, one for each crease or one for all: for so many divisions; 10 for ever; none: 10", range(0, 10),
            Effect::rebuild)
        .member<&SubdivisionSurface::corners>("corners", "1", "vertices that are sharp, counting from 0", Effect::rebuild)
        .member<&SubdivisionSurface::corner_sharpness>("corner_sharpness", "1", "how sharp, in the same way", range(0, 10),
                                                       Effect::rebuild)
        .group("Rules")
        .member<&SubdivisionSurface::scheme>(
            "scheme", "",
            "catmull_clark: for any polygons; loop: for triangles; bilinear: divides faces but does not smooth them",
            choices("catmull_clark", "loop", "bilinear"), Effect::rebuild)
        .member<&SubdivisionSurface::boundary>(
            "boundary", "",
            "what becomes of the cage's open edges. edges: a smooth curve, corners become round; edges_and_corners: the same, "
            "but a corner of a single face stays; none: faces there are left out",
            choices("none", "edges", "edges_and_corners"), Effect::rebuild)
        .member<&SubdivisionSurface::uv_boundary>(
            "uv_boundary", "",
            "how surface coordinates follow the smoothing: linear: not at all; smooth: everywhere; boundaries: only within the "
            "pieces that seams bound; corners: along seams too, but a piece's corners stay; corners_and_junctions: nor do "
            "places where three pieces or more meet move; corners_and_darts: nor ends of seams",
            choices("smooth", "corners", "corners_and_junctions", "corners_and_darts", "boundaries", "linear"), Effect::rebuild)
        .member<&SubdivisionSurface::weld>(
            "weld", "",
            "makes one vertex of those in the same place: files that hold one uv for each vertex split them at seams",
            Effect::rebuild)
        .group("Fineness")
        .member<&SubdivisionSurface::levels>(
            "levels", "1", "each edge of the cage is divided into 2^levels pieces, or fewer:", range(0, 10), Effect::rebuild)
        .member<&SubdivisionSurface::tolerance>(
            "tolerance", "m",
            "how far from the limit surface triangles may lie, before the transform: fewer pieces are made where these are "
            "enough; 0: any",
            at_least(0), Effect::rebuild, soft(0.00001, 0.1), logarithmic)
        .member<&SubdivisionSurface::edge_length>(
            "edge_length", "m",
            "how long edges of triangles may be, before the transform: fewer pieces are made where these are enough; 0: any",
            at_least(0), Effect::rebuild, soft(0.001, 10), logarithmic);
  }

  void prepare() override {
    if (!(tolerance >= 0 && tolerance < infinity)) fail("tolerance", "must be a finite number, 0 or more");
    if (!(edge_length >= 0 && edge_length < infinity)) fail("edge_length", "must be a finite number, 0 or more");
    PolygonMesh cage = file.empty() ? listed() : read();
    const std::string whose = shown_name();
    TidiedVertices vertices;
    try {
      vertices = tidy(cage, weld, whose);
    } catch (const Error& error) {
      fail(file.empty() ? "positions" : "file", error.what());
    }
    if (scheme == SubdivisionRules::Scheme::loop)
      for (size_t f = 0; f < cage.face_sizes.size(); ++f)
        if (cage.face_sizes[f] != 3)
          fail("scheme", "Loop's scheme is for triangles, but face " + std::to_string(f) + " has " +
                             std::to_string(cage.face_sizes[f]) + " corners");
    const SubdivisionRules sharp = rules(cage, vertices);
    LimitMesh limit;
    try {
      limit = limit_mesh(cage, sharp, {levels, tolerance, edge_length});
      drop_unusable(limit.mesh, whose);
    } catch (const Error& error) {
      fail(file.empty() ? "positions" : "file", error.what());
    } catch (const std::bad_alloc&) {
      fail("levels", "not enough memory for so many triangles");
    }
    if (limit.coarse > 0)
      warn(whose + ": " + std::to_string(limit.coarse) + " edges and faces would need more than 2^" + std::to_string(levels) +
               " pieces (levels) for the tolerance or edge_length",
           location_of("levels"));
    if (limit.without_limit > 0 && boundary != SubdivisionRules::Boundary::none)
      warn(whose + ": left out " + std::to_string(limit.without_limit) + " faces that have no limit surface");
    attributes_.take(std::move(limit.mesh.attributes));
    limit.mesh.attributes.clear();
    own_corners_.clear();
    if (!attributes_.empty() && transform.animated()) own_corners_ = limit.mesh.triangles;
    limit.mesh.centre = cage.centre;
    adopt(std::move(limit.mesh));
    const std::optional<TriangleView> view = TriangleObject::triangles();
    corners_ = view ? view->triangles : own_corners_;
  }

  int attribute(int number, const SurfacePoint& p, float* values) const override {
    return attributes_.empty() ? 0 : attributes_.at(number, corners_[p.primitive], p.u, p.v, values);
  }

  FilePath file;
  std::vector<DoublePoint3> positions;
  std::vector<std::uint32_t> face_sizes, indices, uv_indices, creases, corners;
  std::vector<Point2> uvs;
  std::vector<float> crease_sharpness, corner_sharpness;
  SubdivisionRules::Scheme scheme = SubdivisionRules().scheme;
  SubdivisionRules::Boundary boundary = SubdivisionRules().boundary;
  SubdivisionRules::UvBoundary uv_boundary = SubdivisionRules().uv_boundary;
  bool weld = true;
  int levels = Fineness().levels;
  float tolerance = 0, edge_length = 0;

 private:
  std::string shown_name() const {
    if (!file.empty()) return "'" + file.resolved() + "'";
    return origin && !origin->name.empty() ? origin->name : "SubdivisionSurface";
  }

  PolygonMesh read() const {
    if (!positions.empty() || !face_sizes.empty() || !indices.empty() || !uvs.empty() || !uv_indices.empty())
      fail("file", "a cage comes from a file or from lists, not from both");
    try {
      return read_polygon_mesh(file.resolved());
    } catch (const Error& error) {
      fail("file", error.what());
    }
  }

  PolygonMesh listed() const {
    if (positions.empty()) fail("", "a cage needs either a file or positions and indices");
    if (indices.empty()) fail("indices", "there are positions but no faces");
    PolygonMesh cage;
    cage.centre = inner_origin_for(positions);
    cage.positions = relative_to(cage.centre, positions);
    cage.corners = indices;
    cage.face_sizes = face_sizes;
    const size_t usual = scheme == SubdivisionRules::Scheme::loop ? 3 : 4;
    if (face_sizes.empty()) cage.face_sizes.assign((indices.size() + usual - 1) / usual, std::uint32_t(usual));
    std::uint64_t sum = 0;
    for (const std::uint32_t size : cage.face_sizes) {
      if (size < 3) fail("face_sizes", "a face needs at least three corners");
      sum += size;
    }
    if (sum != indices.size())
      fail("indices", std::to_string(indices.size()) + " are given, but the faces have " + std::to_string(sum) + " corners");
    check_indices("indices", indices, positions.size(), "vertex");
    cage.uvs = uvs;
    if (!uv_indices.empty()) {
      if (uv_indices.size() != indices.size())
        fail("uv_indices", std::to_string(uv_indices.size()) + " are given for " + std::to_string(indices.size()) + " corners");
      check_indices("uv_indices", uv_indices, uvs.size(), "surface coordinate");
      cage.uv_corners = uv_indices;
    } else if (!uvs.empty()) {
      if (uvs.size() != positions.size())
        fail("uvs", std::to_string(uvs.size()) + " surface coordinates for " + std::to_string(positions.size()) +
                        " positions and no uv_indices");
      cage.uv_corners = indices;
    }
    return cage;
  }

  void check_indices(const char* member, const std::vector<std::uint32_t>& list, size_t count, const char* what) const {
    for (const std::uint32_t i : list)
      if (i >= count)
        fail(member, std::string("refers to ") + what + " " + std::to_string(i) + " of " + std::to_string(count) +
                         " (counting from 0)");
  }

  /// Expands a list of `count` values, one or none to `count` values.
  std::vector<float> each(const char* member, const std::vector<float>& list, size_t count) const {
    for (const float s : list)
      if (!(s >= 0 && s <= SubdivisionRules::sharpest)) fail(member, "sharpness goes from 0 to 10");
    if (list.size() == count) return list;
    if (list.size() > 1) fail(member, std::to_string(list.size()) + " are given for " + std::to_string(count));
    return std::vector<float>(count, list.empty() ? SubdivisionRules::sharpest : list.front());
  }

  SubdivisionRules rules(const PolygonMesh& cage, const TidiedVertices& vertices) const {
    SubdivisionRules r;
    r.scheme = scheme;
    r.boundary = boundary;
    r.uv_boundary = uv_boundary;
    if (creases.size() % 2 != 0) fail("creases", "two vertices make an edge, but the list is odd");
    check_indices("creases", creases, vertices.now.size(), "vertex");
    check_indices("corners", corners, vertices.now.size(), "vertex");
    r.crease_sharpness = each("crease_sharpness", crease_sharpness, creases.size() / 2);
    r.corner_sharpness = each("corner_sharpness", corner_sharpness, corners.size());
    const auto edge = [](std::uint32_t a, std::uint32_t b) { return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b); };
    std::unordered_set<std::uint64_t> edges;
    size_t from = 0;
    for (const std::uint32_t size : cage.face_sizes) {
      if (creases.empty()) break;
      for (size_t i = 0; i < size; ++i) edges.insert(edge(cage.corners[from + i], cage.corners[from + (i + 1) % size]));
      from += size;
    }
    for (size_t i = 0; i < creases.size(); i += 2) {
      const std::uint32_t a = vertices.now[creases[i]], b = vertices.now[creases[i + 1]];
      if (!edges.contains(edge(a, b)))
        fail("creases",
             "no face has an edge between vertices " + std::to_string(creases[i]) + " and " + std::to_string(creases[i + 1]));
      r.creases.push_back({a, b});
    }
    for (const std::uint32_t c : corners) {
      if (vertices.now[c] == PolygonMesh::none) fail("corners", "no face has vertex " + std::to_string(c));
      r.corners.push_back(vertices.now[c]);
    }
    return r;
  }

  VertexAttributes attributes_;
  std::span<const std::array<std::uint32_t, 3>> corners_;  // of each triangle; empty without attributes
  std::vector<std::array<std::uint32_t, 3>> own_corners_;  // copy of the triangles, for a moving surface
};

const Register<SubdivisionSurface> registered;

}  // namespace
}  // namespace etendue
