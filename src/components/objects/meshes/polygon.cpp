// Polygon: a planar polygon, with or without holes.

#include "geometry/inner_origin.h"
#include "polygon_triangulation.h"
#include "triangle_object.h"

namespace etendue {
namespace {

class Polygon final : public TriangleObject {
  std::vector<DoublePoint3> points{{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}};
  std::vector<DoublePoint3> holes;
  std::vector<std::uint32_t> hole_counts;

 public:
  static void describe(Description<Polygon>& d) {
    d.summary(
         "A planar polygon that does not cross itself; it may be concave and have holes. u goes along its first edge and v "
         "across "
         "it, to the left as seen from the front, from 0 to 1 over the polygon's extent.",
         "ear clipping: Meisters 1975; holes: Eberly 2008, \"Triangulation by ear clipping\"; normal: Newell's method")
        .group("Shape")
        .member<&Polygon::points>("points", "m", "the corners in order, counter-clockwise seen from the front", Effect::rebuild)
        .member<&Polygon::holes>("holes", "m", "the corners of holes in order, either way round, one hole after the other",
                                 Effect::rebuild)
        .member<&Polygon::hole_counts>("hole_counts", "1", "how many of these corners each hole has; none: all are of one",
                                       at_least(3), Effect::rebuild);
  }

  void prepare() override {
    if (points.size() < 3) fail("points", "a polygon needs at least three points, but has " + std::to_string(points.size()));
    // The corners of all outlines in sequence, and the end index of each.
    const DoublePoint3 from = inner_origin_for(points);
    std::vector<Point3> corners = relative_to(from, points);
    const std::vector<Point3> outline = corners, in_holes = relative_to(from, holes);
    corners.insert(corners.end(), in_holes.begin(), in_holes.end());
    std::vector<size_t> ends{points.size()};
    add_holes(ends);
    Bounds3 box;
    for (size_t i = 0; i < corners.size(); ++i) {
      if (!is_finite(corners[i])) fail(i < points.size() ? "points" : "holes", "a point of the polygon is not finite");
      box.add(corners[i]);
    }
    const float size = length(box.diagonal());
    const Vector3 twice_area = newell_normal(outline);
    if (!(length(twice_area) > 1e-7f * size * size)) fail("points", "the polygon has no area");
    const Vector3 n = normalize(twice_area);
    const Point3 centre = box.centre();
    double mean = 0;
    for (const Point3& p : outline) mean += double(dot(n, p - centre)) / double(points.size());
    for (size_t i = 0; i < corners.size(); ++i) {
      const float height = std::abs(dot(n, corners[i] - centre) - float(mean));
      const bool outer = i < points.size();
      if (height > 1e-4f * size)
        fail(outer ? "points" : "holes", "the polygon is not planar: point " + std::to_string(outer ? i : i - points.size()) +
                                             " is " + fmt::format("{:.3g}", height) + " m off its plane");
    }
    MeshData mesh;
    mesh.centre = from;
    mesh.positions.reserve(corners.size() + 1);
    mesh.positions = corners;
    if (holes.empty()) {
      if (!triangulate(outline, mesh.triangles)) fail("points", "the polygon crosses itself");
    } else {
      const PolygonCheck check = triangulate(corners, ends, mesh.triangles);
      const std::string hole = "hole " + std::to_string(check.outline - 1);
      if (check.fault == PolygonFault::outside) fail("holes", hole + " lies outside of the polygon");
      if (check.fault == PolygonFault::nested) fail("holes", hole + " lies in another hole");
      if (check.fault == PolygonFault::crossing && check.outline > 0)
        fail("holes", hole + " crosses itself or another outline");
      if (check.fault == PolygonFault::crossing) fail("points", "the polygon crosses itself");
    }
    // Surface coordinates: u along the first edge that has a length, v across, both over the polygon's extent.
    Vector3 edge;
    for (size_t i = 0; i + 1 < outline.size() && edge == Vector3{}; ++i) edge = outline[i + 1] - outline[i];
    const Vector3 s = normalize(edge - dot(n, edge) * n), t = cross(n, s);
    Point2 low{infinity, infinity}, high{-infinity, -infinity};
    for (const Point3& p : corners) {
      const Point2 uv{dot(s, p - centre), dot(t, p - centre)};
      low = {std::min(low.x, uv.x), std::min(low.y, uv.y)};
      high = {std::max(high.x, uv.x), std::max(high.y, uv.y)};
      mesh.uvs.push_back(uv);
    }
    for (Point2& uv : mesh.uvs) uv = {(uv.x - low.x) / (high.x - low.x), (uv.y - low.y) / (high.y - low.y)};
    try {
      drop_unusable(mesh, "Polygon");
    } catch (const Error& error) {
      fail("points", error.what());
    }
    adopt(std::move(mesh));
  }

 private:
  void add_holes(std::vector<size_t>& ends) const {
    if (holes.empty() && hole_counts.empty()) return;
    if (hole_counts.empty()) {
      if (holes.size() < 3) fail("holes", "a hole needs at least three points, but has " + std::to_string(holes.size()));
      ends.push_back(points.size() + holes.size());
      return;
    }
    size_t sum = 0;
    for (const std::uint32_t count : hole_counts) {
      if (count < 3) fail("hole_counts", "a hole needs at least three points, but has " + std::to_string(count));
      ends.push_back(points.size() + (sum += count));
    }
    if (sum != holes.size())
      fail("hole_counts",
           "they add up to " + std::to_string(sum) + ", but there are " + std::to_string(holes.size()) + " points of holes");
  }
};

const Register<Polygon> registered;

}  // namespace
}  // namespace etendue
