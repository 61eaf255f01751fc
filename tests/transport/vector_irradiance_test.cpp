// Samples of points on nearby lamps, to 0.05 %: the sum of their directions over their pdfs is the integral of the direction
// over the lamp's solid angle, which has closed forms. For a polygon (Lambert 1760; Arvo 1994) it is half the sum over its
// edges of the angle under which an edge is seen, times the unit normal of the plane through edge and eye; for a sphere, pi
// times the squared sine of the angle of its radius, towards its centre.

#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

using Vector = std::array<double, 3>;

Vector cross_product(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot_product(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector of_polygon(const Point3& from, const std::vector<Vector>& corners) {
  Vector sum{}, towards{};
  for (size_t i = 0; i < corners.size(); ++i) {
    Vector a, b;
    for (size_t k = 0; k < 3; ++k) {
      a[k] = corners[i][k] - double(from[int(k)]);
      b[k] = corners[(i + 1) % corners.size()][k] - double(from[int(k)]);
      towards[k] += a[k];
    }
    const Vector n = cross_product(a, b);
    const double l = std::sqrt(dot_product(n, n)), angle = std::atan2(l, dot_product(a, b));
    for (size_t k = 0; k < 3; ++k) sum[k] += 0.5 * angle * n[k] / l;
  }
  if (dot_product(sum, towards) < 0)
    for (double& x : sum) x = -x;
  return sum;
}

Vector sampled(const SceneObject& lamp, const Point3& from) {
  constexpr int side = 384;
  Vector sum{};
  for (int i = 0; i < side * side; ++i) {
    const SurfaceSample s = lamp.sample_visible(from, {(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side}, 0);
    if (!(s.pdf > 0)) continue;
    for (size_t k = 0; k < 3; ++k) sum[k] += double(s.direction[int(k)]) / double(s.pdf) / (side * side);
  }
  return sum;
}

void expect_same(const Vector& a, const Vector& b) {
  const double length = std::sqrt(dot_product(b, b));
  for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 5e-4 * length) << k;
}

TEST(VectorIrradiance, OfRectanglesAndTriangles) {
  for (const Point3& from : {Point3{0.2f, 0.1f, 0.5f}, {0.9f, -0.3f, 0.4f}, {-0.4f, 0.8f, -0.3f}, {2, 1, 4}}) {
    SCOPED_TRACE(from.z);
    const auto right = object("Rectangle", {{"corner", {-0.5, -0.4, 0}}, {"edge_u", {1, 0, 0}}, {"edge_v", {0, 0.9, 0}}});
    expect_same(sampled(*right, from), of_polygon(from, {{-0.5, -0.4, 0}, {0.5, -0.4, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}}));
    const auto slanted = object("Rectangle", {{"corner", {-0.5, -0.4, 0}}, {"edge_u", {1, 0, 0.1}}, {"edge_v", {0.4, 0.9, 0}}});
    expect_same(sampled(*slanted, from),
                of_polygon(from, {{-0.5, -0.4, 0}, {0.5, -0.4, 0.1}, {0.9, 0.5, 0.1}, {-0.1, 0.5, 0}}));
    const auto triangle =
        object("TriangleMesh", {{"positions", {-0.6, -0.5, 0, 0.8, -0.2, 0.1, 0.1, 0.7, -0.1}}, {"triangles", {0, 1, 2}}});
    expect_same(sampled(*triangle, from), of_polygon(from, {{-0.6, -0.5, 0}, {0.8, -0.2, 0.1}, {0.1, 0.7, -0.1}}));
  }
}

TEST(VectorIrradiance, OfBalls) {
  const auto ball = object("Sphere", {{"radius", 0.8}, {"centre", {0.1, 0.2, -0.3}}});
  for (const double distance : {0.81, 0.9, 1.2, 3.0, 100.0}) {
    SCOPED_TRACE(distance);
    const Vector away = {0.48, -0.6, 0.64}, centre = {0.1, 0.2, -0.3};
    Vector expected;
    for (size_t k = 0; k < 3; ++k) expected[k] = -away[k] * M_PI * std::pow(0.8 / distance, 2);
    expect_same(sampled(*ball, {float(centre[0] + distance * away[0]), float(centre[1] + distance * away[1]),
                                float(centre[2] + distance * away[2])}),
                expected);
  }
}

}  // namespace
}  // namespace etendue
