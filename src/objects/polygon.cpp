// Polygon: a flat outline.

#include "polygon_triangulation.h"
#include "triangle_object.h"

namespace etendue {

class Polygon final : public TriangleObject {
  std::vector<Point3> points{{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}};

 public:
  static void describe(Description<Polygon>& d) {
    d.summary("A planar polygon that does not cross itself; it may be concave.",
              "ear clipping: Meisters 1975; normal: Newell's method")
        .member<&Polygon::points>("points", "m", "the corners in order, counter-clockwise seen from the front",
                                  Effect::rebuild);
  }

  void prepare() override {
    if (points.size() < 3) fail("points", "a polygon needs at least three points, but has " + std::to_string(points.size()));
    Bounds3 box;
    for (const Point3& p : points) {
      if (!is_finite(p)) fail("points", "a point of the polygon is not finite");
      box.add(p);
    }
    const float size = length(box.diagonal());
    const Vector3 twice_area = newell_normal(points);
    if (!(length(twice_area) > 1e-7f * size * size)) fail("points", "the polygon has no area");
    const Vector3 n = normalize(twice_area);
    const Point3 centre = box.centre();
    double mean = 0;
    for (const Point3& p : points) mean += double(dot(n, p - centre)) / double(points.size());
    for (size_t i = 0; i < points.size(); ++i) {
      const float height = std::abs(dot(n, points[i] - centre) - float(mean));
      if (height > 1e-4f * size)
        fail("points",
             "the polygon is not planar: point " + std::to_string(i) + " is " + std::to_string(height) + " m off its plane");
    }
    MeshData mesh;
    mesh.positions.reserve(points.size() + 1);
    mesh.positions = points;
    if (!triangulate(points, mesh.triangles)) fail("points", "the polygon crosses itself");
    // Surface coordinates: u along the first edge that has a length, v across, both over the polygon's extent.
    Vector3 edge;
    for (size_t i = 0; i + 1 < points.size() && edge == Vector3{}; ++i) edge = points[i + 1] - points[i];
    const Vector3 s = normalize(edge - dot(n, edge) * n), t = cross(n, s);
    Point2 low{infinity, infinity}, high{-infinity, -infinity};
    for (const Point3& p : points) {
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
};

static const Register<Polygon> registered;

}  // namespace etendue
