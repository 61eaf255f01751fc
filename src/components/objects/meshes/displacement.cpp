// Displaces the vertices of a surface by maps and computes the normals of the displaced shape.

#include "displacement.h"

#include <tbb/parallel_for.h>

#include <mutex>

#include "etendue/core/error.h"
#include "geometry/point_groups.h"

namespace etendue {
namespace {

/// The angle at a triangle's corner [rad].
float angle(const Vector3& a, const Vector3& b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

class Displacer {
 public:
  Displacer(const DividedTriangles& triangles, const Displacement& displacement)
      : in_(triangles), by_(displacement), groups_(triangles.positions, triangles.triangles) {}

  MeshData run() {
    find_uvs();
    move();
    shade();
    return std::move(out_);
  }

 private:
  struct Corner {
    size_t triangle, number;
  };
  static Corner corner(std::uint64_t c) { return {size_t(c / 3), size_t(c % 3)}; }
  std::uint32_t vertex(std::uint64_t c) const { return in_.triangles[c / 3][c % 3]; }

  /// The point of the undisplaced surface at a corner.
  SurfacePoint original(std::uint64_t c) const {
    const Corner at = corner(c);
    const DividedTriangles::Place place = in_.corner(at.triangle, at.number);
    SurfacePoint p;
    Hit hit;
    hit.object = by_.surface;
    hit.primitive = place.triangle;
    hit.u = place.u;
    hit.v = place.v;
    by_.surface->surface_point(Ray{}, hit, p);
    return p;
  }
  Vector3 edge(std::uint64_t c, size_t step, const std::vector<Point3>& positions) const {
    const auto& t = in_.triangles[c / 3];
    return positions[t[(c + step) % 3]] - positions[t[c % 3]];
  }

  // A surface without surface coordinates returns the barycentric ones of each triangle, which differ between triangles that
  // share a vertex; these are not stored.
  void find_uvs() {
    std::vector<Point2> uvs(in_.positions.size());
    std::vector<bool> known(uvs.size());
    for (std::uint64_t c = 0; c < 3 * in_.triangles.size(); ++c) {
      const std::uint32_t v = vertex(c);
      const Point2 uv = original(c).uv;
      if (known[v] && (std::abs(uv.x - uvs[v].x) > 1e-4f * (1 + std::abs(uv.x)) ||
                       std::abs(uv.y - uvs[v].y) > 1e-4f * (1 + std::abs(uv.y))))
        return;
      uvs[v] = uv;
      known[v] = true;
    }
    out_.uvs = std::move(uvs);
  }

  /// Sets the footprint over which maps may average: the distance of neighbouring vertices.
  void widen(SurfacePoint& p, std::uint64_t c) const {
    p.position = in_.positions[vertex(c)];  // the same for all vertices at this position
    p.object_position = Point3(DoublePoint3(p.position) + (by_.surface->transform.outer_origin() - DoublePoint3{}));
    p.object_normal = p.normal;
    p.footprint = std::min(length(edge(c, 1, in_.positions)), length(edge(c, 2, in_.positions)));
    p.footprint_cosine = 1;
  }

  /// Axes along u, perpendicular to u on the side towards which v increases, and along the shading normal; not always
  /// right-handed.
  static Frame tangent_frame(const SurfacePoint& p) {
    const Normal3& n = p.shading_normal;
    const Vector3 s = p.dpdu - dot(n, p.dpdu) * Vector3(n);
    const float l = length(s);
    Frame frame(n);
    if (l > 1e-6f * length(p.dpdu) && l < infinity) frame = Frame(s / l, cross(Vector3(n), s / l), n);
    if (dot(frame.t, p.dpdv) < 0) frame.t = -frame.t;
    return frame;
  }

  float value(const ObjectMap& map, const SurfacePoint& p) const {
    const float m = by_.scale * (map.scalar(p) - by_.midlevel);
    return std::isfinite(m) ? m : 0;
  }

  void move() {
    out_.positions.reserve(in_.positions.size() + 1);  // one more, for the padding the object adds
    out_.positions = in_.positions;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, groups_.size()), [&](const tbb::blocked_range<size_t>& some) {
      std::vector<std::uint32_t> seen;
      for (size_t g = some.begin(); g < some.end(); ++g) {
        if (groups_.corners(g).empty()) continue;
        seen.clear();
        Vector3 normal{}, offset{};
        float height = 0;
        for (const std::uint64_t c : groups_.corners(g)) {
          SurfacePoint p = original(c);
          normal += angle(edge(c, 1, in_.positions), edge(c, 2, in_.positions)) * Vector3(p.shading_normal);
          if (std::find(seen.begin(), seen.end(), vertex(c)) != seen.end()) continue;
          seen.push_back(vertex(c));
          by_.surface->tangents(p);
          const Frame frame = by_.along_tangents ? tangent_frame(p) : Frame({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
          widen(p, c);
          if (by_.height) height += value(*by_.height, p);
          if (!by_.offset.empty())
            offset += frame.to_world({value(*by_.offset[0], p), value(*by_.offset[1], p), value(*by_.offset[2], p)});
        }
        const float l = length(normal), mean = 1 / float(seen.size());
        Vector3 by = mean * offset;
        if (l > 1e-6f) by += (mean * height / l) * normal;
        for (const std::uint32_t v : seen) out_.positions[v] = in_.positions[v] + by;
      }
    });
  }

  // Normals of the displaced shape: means of the triangles' normals, weighted by their angles (Thürmer & Wüthrich 1998,
  // "Computing vertex normals from polygonal facets"), over those corners at one position whose normals were similar before the
  // displacement, so that a hard edge stays hard. A vertex whose corners get different normals in this way is duplicated.
  void shade() {
    out_.triangles = in_.triangles;
    out_.normals.resize(out_.positions.size());
    struct Copy {
      std::uint64_t corner;
      Normal3 normal;
    };
    tbb::parallel_for(tbb::blocked_range<size_t>(0, groups_.size()), [&](const tbb::blocked_range<size_t>& some) {
      struct Part {
        Vector3 before, sum;
      };
      std::vector<Part> parts;
      std::vector<size_t> part_of;
      std::vector<std::pair<std::uint32_t, size_t>> owners;  // vertices, and the part whose normal each has
      std::vector<Copy> copies;
      for (size_t g = some.begin(); g < some.end(); ++g) {
        const auto corners = groups_.corners(g);
        parts.clear();
        part_of.clear();
        owners.clear();
        for (const std::uint64_t c : corners) {
          const Vector3 before(original(c).shading_normal), a = edge(c, 1, out_.positions), b = edge(c, 2, out_.positions);
          size_t k = 0;
          while (k < parts.size() && dot(parts[k].before, before) < by_.smooth_cosine) ++k;
          if (k == parts.size()) parts.push_back({before, {}});
          const Vector3 n = cross(a, b);
          const float l = length(n);
          if (l > 0) parts[k].sum += (std::atan2(l, dot(a, b)) / l) * n;
          part_of.push_back(k);
        }
        for (size_t i = 0; i < corners.size(); ++i) {
          const std::uint32_t v = vertex(corners[i]);
          const float l = length(parts[part_of[i]].sum);
          const Normal3 n = l > 0 ? Normal3(parts[part_of[i]].sum / l) : Normal3{};
          const auto owner = std::find_if(owners.begin(), owners.end(), [&](const auto& o) { return o.first == v; });
          if (owner == owners.end()) {
            owners.push_back({v, part_of[i]});
            out_.normals[v] = n;
          } else if (owner->second != part_of[i]) {
            copies.push_back({corners[i], n});
          }
        }
      }
      if (copies.empty()) return;
      const std::lock_guard lock(mutex_);
      for (const Copy& copy : copies) copies_.push_back({copy.corner, copy.normal});
    });
    std::sort(copies_.begin(), copies_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [c, normal] : copies_) {
      const std::uint32_t v = vertex(c);
      out_.triangles[c / 3][c % 3] = std::uint32_t(out_.positions.size());
      out_.positions.push_back(Point3(out_.positions[v]));
      out_.normals.push_back(normal);
      if (!out_.uvs.empty()) out_.uvs.push_back(Point2(out_.uvs[v]));
    }
  }

  const DividedTriangles& in_;
  const Displacement& by_;
  const PointGroups groups_;
  MeshData out_;
  std::mutex mutex_;
  std::vector<std::pair<std::uint64_t, Normal3>> copies_;
};

}  // namespace

MeshData displace(const DividedTriangles& triangles, const Displacement& displacement) {
  return Displacer(triangles, displacement).run();
}

}  // namespace etendue
