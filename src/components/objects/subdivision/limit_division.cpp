#include "limit_division.h"

#include <opensubdiv/bfr/tessellation.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "etendue/core/error.h"

namespace etendue {
namespace {

class Divider {
 public:
  Divider(const Far::TopologyLevel& base, const LimitSurfaces& surfaces, const CageValues& values, const Fineness& fineness)
      : base_(base), surfaces_(surfaces), values_(values), fineness_(fineness), most_pieces_(1 << fineness.levels) {}

  // Triangles with corners on a surface in steps of 1/n by s and 1/m by t are at most
  //     (D_ss / n^2 + 2 D_st / (n m) + D_tt / m^2) / 8
  // from it, where D bounds the lengths of second derivatives (Filip, Magedson & Markot 1986, "Surface algorithms using bounds
  // on derivatives"); with 2 / (n m) <= 1 / n^2 + 1 / m^2 each direction gets half of the tolerance. A curve's chords are at
  // most D / (8 n^2) from it. The derivatives are evaluated at 9 points along an edge and 25 points in a face.
  CageDivision divide() {
    const size_t faces = size_t(base_.GetNumFaces());
    result_.edges.assign(size_t(base_.GetNumEdges()), most_pieces_);
    result_.faces.assign(faces, {});
    const bool adaptive = fineness_.tolerance > 0 || fineness_.edge_length > 0;
    for_each_face(faces, surfaces_, values_, [&](LimitSurface& s, int f) {
      CageDivision::Face& d = result_.faces[size_t(f)];
      d.exists = adaptive ? s.load(f) : surfaces_.FaceHasLimitSurface(f);
      if (!d.exists) return;
      d.inside = most_pieces_;
      if (!adaptive) return;
      const Far::ConstIndexArray edges = base_.GetFaceEdges(f);
      for (int i = 0; i < edges.size(); ++i)
        if (first_with_surface(edges[i]) == f) result_.edges[size_t(edges[i])] = pieces_along(s, i);
      d.inside = pieces_inside(s);
    });
    result_.coarse = coarse_;
    result_.without_limit = size_t(
        std::count_if(result_.faces.begin(), result_.faces.end(), [](const CageDivision::Face& d) { return !d.exists; }));
    if (result_.without_limit == faces) throw Error("no face has a limit surface: all lie at a boundary that is not kept");
    return std::move(result_);
  }

 private:
  int limited(double pieces) {
    if (!(pieces > most_pieces_)) return std::max(1, int(std::ceil(pieces - 1e-9)));
    ++coarse_;
    return most_pieces_;
  }

  int first_with_surface(int edge) const {
    for (const int f : base_.GetEdgeFaces(edge))
      if (surfaces_.FaceHasLimitSurface(f)) return f;
    return -1;
  }

  int pieces_along(LimitSurface& s, int edge) {
    constexpr int steps = 8;
    std::array<std::array<double, 3>, steps + 1> p;
    for (int i = 0; i <= steps; ++i) {
      double st[2];
      s.parameters().GetEdgeCoord(edge, double(i) / steps, st);
      p[size_t(i)] = s.position(st);
    }
    double length = 0, second = 0;
    for (size_t i = 0; i < steps; ++i) {
      double first_difference = 0, second_difference = 0;
      for (size_t k = 0; k < 3; ++k) {
        const double d = p[i + 1][k] - p[i][k], dd = i > 0 ? d - (p[i][k] - p[i - 1][k]) : 0;
        first_difference += d * d;
        second_difference += dd * dd;
      }
      length += std::sqrt(first_difference);
      second = std::max(second, steps * steps * std::sqrt(second_difference));
    }
    double pieces = 1;
    if (fineness_.tolerance > 0) pieces = std::sqrt(second / (8 * double(fineness_.tolerance)));
    if (fineness_.edge_length > 0) pieces = std::max(pieces, length / double(fineness_.edge_length));
    return limited(pieces);
  }

  int pieces_inside(LimitSurface& s) {
    const Bfr::Tessellation sample(s.parameters(), 4);
    std::vector<double> places(size_t(2 * sample.GetNumCoords()));
    sample.GetCoords(places.data());
    std::array<double, 5> most{};
    for (size_t i = 0; i < places.size(); i += 2) {
      const std::array<double, 5> here = s.sizes(&places[i]);
      for (size_t k = 0; k < 5; ++k) most[k] = std::max(most[k], here[k]);
    }
    std::array<double, 2> pieces{1, 1};
    for (size_t k = 0; k < 2; ++k) {
      if (fineness_.tolerance > 0) pieces[k] = std::sqrt((most[k == 0 ? 2 : 4] + most[3]) / (4 * double(fineness_.tolerance)));
      if (fineness_.edge_length > 0) pieces[k] = std::max(pieces[k], most[k] / double(fineness_.edge_length));
    }
    return limited(std::max(pieces[0], pieces[1]));
  }

  const Far::TopologyLevel& base_;
  const LimitSurfaces& surfaces_;
  const CageValues& values_;
  const Fineness& fineness_;
  const int most_pieces_;
  std::atomic<size_t> coarse_ = 0;
  CageDivision result_;
};

}  // namespace

CageValues::CageValues(const PolygonMesh& cage) {
  for (const VertexAttribute& a : cage.attributes) width += a.width;
  const size_t count = cage.positions.size(), w = size_t(width);
  vertices.resize(count * w);
  for (size_t i = 0; i < count; ++i) {
    double* to = &vertices[i * w];
    for (int k = 0; k < 3; ++k) *to++ = double(cage.positions[i][k]);
    for (const VertexAttribute& a : cage.attributes)
      for (int k = 0; k < a.width; ++k) *to++ = double(a.values[i * size_t(a.width) + size_t(k)]);
  }
  if (cage.uv_corners.empty()) return;
  for (const Point2& uv : cage.uvs) uvs.insert(uvs.end(), {double(uv.x), double(uv.y)});
}

CageDivision divide_cage(const Far::TopologyLevel& base, const LimitSurfaces& surfaces, const CageValues& values,
                         const Fineness& fineness) {
  return Divider(base, surfaces, values, fineness).divide();
}

}  // namespace etendue
