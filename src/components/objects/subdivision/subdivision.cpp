// Tessellation of a limit surface into triangles.

#include "subdivision.h"

#include <opensubdiv/bfr/tessellation.h>

#include "etendue/core/error.h"
#include "limit_division.h"

namespace etendue {
namespace {

constexpr std::uint64_t most_vertices = std::uint64_t(1) << 27;

/// Start indices in an array for runs of given lengths (exclusive prefix sum); the last entry is the sum.
template <class F>
std::vector<std::uint64_t> starts(size_t count, F&& length) {
  std::vector<std::uint64_t> start(count + 1);
  for (size_t i = 0; i < count; ++i) start[i + 1] = start[i] + length(i);
  return start;
}

// Order of the vertices of the result: first those at the cage's vertices, then those within its edges, shared by the adjacent
// faces, then those within faces, then copies of shared vertices for faces with a different normal or surface coordinates
// there.
class LimitTessellation {
 public:
  LimitTessellation(const PolygonMesh& cage, const SubdivisionRules& rules, const Fineness& fineness)
      : topology_(cage_topology(cage, rules)),
        base_(topology_->GetLevel(0)),
        surfaces_(*topology_),
        cage_(&cage),
        values_(cage),
        division_(divide_cage(base_, surfaces_, values_, fineness)),
        uvs_(!cage.uv_corners.empty()),
        extra_(size_t(values_.width - 3)) {
    result_.coarse = division_.coarse;
    result_.without_limit = division_.without_limit;
  }

  LimitMesh make() {
    lay_out();
    evaluate();
    share();
    make_triangles();
    return std::move(result_);
  }

 private:
  size_t faces() const { return division_.faces.size(); }
  template <class F>
  void each_face(F&& f) const {
    for_each_face(faces(), surfaces_, values_, f);
  }

  Bfr::Tessellation pattern(int f) const {
    thread_local std::vector<int> rates;
    rates.clear();
    for (const int e : base_.GetFaceEdges(f)) rates.push_back(division_.edges[size_t(e)]);
    const CageDivision::Face& d = division_.faces[size_t(f)];
    const Bfr::Parameterization p = surfaces_.GetFaceParameterization(f);
    rates.push_back(d.inside);
    return Bfr::Tessellation(p, int(rates.size()), rates.data());
  }

  void lay_out() {
    edge_start_ = starts(division_.edges.size(), [&](size_t e) { return std::uint64_t(division_.edges[e] - 1); });
    shared_ = std::uint64_t(base_.GetNumVertices()) + edge_start_.back();
    for (std::uint64_t& s : edge_start_) s += std::uint64_t(base_.GetNumVertices());
    std::vector<std::array<std::uint64_t, 3>> counts(faces());
    each_face([&](LimitSurface&, int f) {
      if (!division_.faces[size_t(f)].exists) return;
      const Bfr::Tessellation t = pattern(f);
      counts[size_t(f)] = {std::uint64_t(t.GetNumBoundaryCoords()), std::uint64_t(t.GetNumInteriorCoords()),
                           std::uint64_t(t.GetNumFacets())};
    });
    border_start_ = starts(faces(), [&](size_t f) { return counts[f][0]; });
    inside_start_ = starts(faces(), [&](size_t f) { return counts[f][1]; });
    triangle_start_ = starts(faces(), [&](size_t f) { return counts[f][2]; });
    for (std::uint64_t& s : inside_start_) s += shared_;
    if (inside_start_.back() + border_start_.back() > most_vertices || triangle_start_.back() > most_vertices)
      throw Error("there would be " + std::to_string(triangle_start_.back()) + " triangles, more than 2^27");
  }

  /// Evaluates all points. Points within faces are stored in the mesh; points on the borders of faces are collected for
  /// `share`.
  void evaluate() {
    resize(inside_start_.back());
    borders_.resize(border_start_.back());
    border_attributes_.resize(extra_ * borders_.size());
    each_face([&](LimitSurface& s, int f) {
      if (!division_.faces[size_t(f)].exists || !s.load(f)) return;
      const Bfr::Tessellation t = pattern(f);
      thread_local std::vector<double> places;
      places.resize(size_t(2 * t.GetNumCoords()));
      t.GetCoords(places.data());
      std::vector<float> attributes(extra_ + 1);
      const size_t on_border = size_t(t.GetNumBoundaryCoords());
      for (size_t i = 0; i < size_t(t.GetNumCoords()); ++i) {
        const LimitPoint p = s.at(&places[2 * i], attributes.data());
        if (i < on_border) {
          const size_t at = border_start_[size_t(f)] + i;
          borders_[at] = p;
          std::copy_n(attributes.begin(), extra_, border_attributes_.begin() + std::ptrdiff_t(extra_ * at));
        } else {
          put(inside_start_[size_t(f)] + i - on_border, p, attributes.data());
        }
      }
    });
  }

  void resize(size_t vertices) {
    MeshData& mesh = result_.mesh;
    mesh.positions.reserve(vertices + 1);  // one more, for the padding the object adds
    mesh.positions.resize(vertices);
    mesh.normals.resize(vertices);
    if (uvs_) mesh.uvs.resize(vertices);
    if (mesh.attributes.empty())
      for (const VertexAttribute& a : cage_->attributes) mesh.attributes.push_back({a.name, a.width, {}});
    for (VertexAttribute& a : mesh.attributes) a.values.resize(vertices * size_t(a.width));
  }

  void put(size_t vertex, const LimitPoint& p, const float* attributes) {
    MeshData& mesh = result_.mesh;
    mesh.positions[vertex] = p.position;
    mesh.normals[vertex] = p.normal;
    if (uvs_) mesh.uvs[vertex] = p.uv;
    for (VertexAttribute& a : mesh.attributes) {
      std::copy_n(attributes, a.width, a.values.begin() + std::ptrdiff_t(vertex * size_t(a.width)));
      attributes += a.width;
    }
  }

  /// Calls visit(i, number) for the points on a face's border in order, with the number of the shared point: a vertex, then the
  /// points within the edge that follows it, and so on around the face.
  template <class F>
  void around(int f, F&& visit) const {
    const Far::ConstIndexArray corners = base_.GetFaceVertices(f), edges = base_.GetFaceEdges(f);
    size_t i = 0;
    for (int c = 0; c < corners.size(); ++c) {
      visit(i++, std::uint64_t(corners[c]));
      const bool forwards = base_.GetEdgeVertices(edges[c])[0] == corners[c];
      const std::uint64_t first = edge_start_[size_t(edges[c])], count = std::uint64_t(division_.edges[size_t(edges[c])] - 1);
      for (std::uint64_t k = 0; k < count; ++k) visit(i++, forwards ? first + k : first + count - 1 - k);
    }
  }

  // The first face that contains a shared point determines its position, so that there are no cracks; faces with a different
  // normal or different surface coordinates there get copies of the point, stored in a linked list.
  void share() {
    constexpr std::uint32_t none = PolygonMesh::none;
    struct Copy {
      size_t border;
      std::uint32_t vertex, next;
    };
    std::vector<Copy> copies;
    std::vector<std::uint32_t> first(shared_, none);
    std::vector<size_t> source(shared_);
    border_vertices_.resize(borders_.size());
    const auto same = [&](const LimitPoint& a, const LimitPoint& b) {
      constexpr float least_cosine = 0.9999f;  // 0.8 degrees: adjacent patches at an irregular vertex differ by much less
      const bool normals = a.normal == b.normal || dot(a.normal, b.normal) > least_cosine;
      return normals && std::abs(a.uv.x - b.uv.x) <= 1e-5f * (1 + std::abs(a.uv.x)) &&
             std::abs(a.uv.y - b.uv.y) <= 1e-5f * (1 + std::abs(a.uv.y));
    };
    std::uint64_t vertices = inside_start_.back();
    for (size_t f = 0; f < faces(); ++f) {
      if (!division_.faces[f].exists) continue;
      around(int(f), [&](size_t i, std::uint64_t point) {
        const size_t border = border_start_[f] + i;
        std::uint32_t c = first[point];
        while (c != none && !same(borders_[copies[c].border], borders_[border])) c = copies[c].next;
        if (c == none) {
          const bool original = first[point] == none;
          if (original) source[point] = border;
          copies.push_back({border, std::uint32_t(original ? point : vertices++), first[point]});
          c = first[point] = std::uint32_t(copies.size() - 1);
        }
        border_vertices_[border] = copies[c].vertex;
      });
    }
    resize(vertices);
    for (size_t point = 0; point < shared_; ++point)
      for (std::uint32_t c = first[point]; c != none; c = copies[c].next) {
        LimitPoint p = borders_[copies[c].border];
        p.position = borders_[source[point]].position;
        put(copies[c].vertex, p, border_attributes_.data() + extra_ * source[point]);
      }
  }

  void make_triangles() {
    auto& triangles = result_.mesh.triangles;
    triangles.resize(triangle_start_.back());
    each_face([&](LimitSurface&, int f) {
      if (!division_.faces[size_t(f)].exists) return;
      Bfr::Tessellation t = pattern(f);
      const size_t on_border = size_t(t.GetNumBoundaryCoords()), at = triangle_start_[size_t(f)];
      thread_local std::vector<int> facets;
      facets.resize(size_t(3 * t.GetNumFacets()));
      t.GetFacets(facets.data());
      for (size_t i = 0; i < facets.size(); ++i) {
        const auto k = size_t(facets[i]);
        triangles[at + i / 3][i % 3] = k < on_border ? border_vertices_[border_start_[size_t(f)] + k]
                                                     : std::uint32_t(inside_start_[size_t(f)] + k - on_border);
      }
    });
  }

  std::unique_ptr<Far::TopologyRefiner> topology_;
  Far::TopologyLevel base_;
  LimitSurfaces surfaces_;
  const PolygonMesh* cage_;
  const CageValues values_;
  const CageDivision division_;
  const bool uvs_;
  const size_t extra_;  // attribute values per vertex, after the position

  std::uint64_t shared_ = 0;
  std::vector<std::uint64_t> edge_start_, border_start_, inside_start_, triangle_start_;
  std::vector<LimitPoint> borders_;  // border points, as evaluated from each face
  std::vector<float> border_attributes_;
  std::vector<std::uint32_t> border_vertices_;
  LimitMesh result_;
};

}  // namespace

LimitMesh limit_mesh(const PolygonMesh& cage, const SubdivisionRules& rules, const Fineness& fineness) {
  if (cage.positions.size() > most_vertices || cage.corners.size() > most_vertices || cage.uvs.size() > most_vertices)
    throw Error("more than 2^27 vertices");
  return LimitTessellation(cage, rules, fineness).make();
}

}  // namespace etendue
