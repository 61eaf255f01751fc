// Triangles that BruteForceScene tests two at a time, against each triangle tested alone in double precision.

#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

struct Double3 {
  double x, y, z;
};
Double3 difference(const Point3& a, const Point3& b) {
  return {double(a.x) - double(b.x), double(a.y) - double(b.y), double(a.z) - double(b.z)};
}
Double3 as_double(const Vector3& v) { return {v.x, v.y, v.z}; }
Double3 cross(const Double3& a, const Double3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Double3& a, const Double3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Expected {
  double t = 0, u = 0, v = 0;
  double cosine = 0;  ///< between ray and normal
  double margin = 0;  ///< how far inside (negative: outside) the ray passes, as a barycentric weight
};

Expected meet(const Ray& ray, const std::array<Point3, 3>& p) {
  const Double3 a = difference(p[1], p[0]), b = difference(p[2], p[0]), c = difference(p[0], ray.origin);
  const Double3 d = as_double(ray.direction), n = cross(a, b), r = cross(c, d);
  const double inverse = 1 / dot(n, d);
  Expected e{dot(n, c) * inverse, dot(r, b) * inverse, -dot(r, a) * inverse, std::abs(dot(n, d)) / std::sqrt(dot(n, n)), 0};
  e.margin = std::min({e.u, e.v, 1 - e.u - e.v});
  return e;
}

enum class Shape { convex, concave, bent, folded };

/// The corners A, B, C, D of two triangles ABC and ACD.
std::array<Point3, 4> corners(Shape shape, Random& random) {
  const Vector3 normal = random.direction(), s = Frame(Normal3(normal)).s, t = Frame(Normal3(normal)).t;
  const Point3 a = random.in_box(1);
  const auto at = [&](float x, float y, float z) { return a + (x * s + y * t + z * normal); };
  const float right = random.between(0.2f, 1), left = random.between(0.2f, 1);
  switch (shape) {
    case Shape::convex:
      return {a, at(right, random.between(0.3f, 0.6f), 0), at(0, 1, 0), at(-left, random.between(0.3f, 0.6f), 0)};
    case Shape::concave: return {a, at(right, -0.7f, 0), at(0, 1, 0), at(-left, -0.7f, 0)};
    case Shape::bent: return {a, at(right, 0.4f, 0), at(0, 1, 0), at(-left, 0.5f, 0.1f)};
    default: return {a, at(right, 0.4f, 0), at(0, 1, 0), at(left, 0.7f, 0)};
  }
}

class Pairs : public testing::TestWithParam<Shape> {};

// In whatever order triangles and their corners are given, the nearest triangle is found, with the weights of its own corners.
// A convex quadrilateral with corners on a grid of eighths is exactly planar and is tested as one pair; other pairs, and
// randomly oriented ones, are tested with their rounded corners. The other structures find the same hits.
TEST_P(Pairs, AreMetAsTheirTrianglesAre) {
  Random random(11);
  for (int trial = 0; trial < 400; ++trial) {
    std::array<Point3, 4> quad = corners(GetParam(), random);
    const bool exact = trial % 2 == 0;
    if (exact) {  // in one of the planes of the axes, to eighths
      const int axis = int(3 * random.number());
      for (Point3& p : quad) {
        for (int k = 0; k < 3; ++k) p[k] = std::round(16 * p[k]) / 8;
        if (GetParam() != Shape::bent) p[axis] = 0.5f;
      }
    }
    // Each triangle begins with a random corner and has a random orientation; either triangle comes first.
    std::vector<std::array<Point3, 3>> triangles = {{quad[0], quad[1], quad[2]}, {quad[0], quad[2], quad[3]}};
    for (auto& t : triangles) {
      std::rotate(t.begin(), t.begin() + int(3 * random.number()), t.end());
      if (random.number() < 0.5f) std::swap(t[0], t[1]);
    }
    if (random.number() < 0.5f) std::swap(triangles[0], triangles[1]);
    std::vector<double> positions, indices;
    bool flat = false;
    for (const auto& t : triangles) {
      flat = flat || !(length(cross(t[1] - t[0], t[2] - t[0])) > 0.01f);
      for (const Point3& p : t) {
        positions.insert(positions.end(), {double(p.x), double(p.y), double(p.z)});
        indices.push_back(double(indices.size()));
      }
    }
    if (flat) continue;
    const char* const structures[] = {"BruteForceScene", "BvhScene",    "BruteForceScene",
                                      "EmbreeScene",     "OctreeScene", "GridScene"};
    const char* const structure = structures[trial / 2 % 6];
    const Ref<Scene> scene = ref_cast<Scene>(Registry::instance().create(structure));
    scene->objects = {object("TriangleMesh", {{"positions", positions}, {"triangles", indices}})};
    prepare_tree(*scene);

    for (int i = 0; i < 60; ++i) {
      Ray ray;
      ray.origin = random.in_box(4);
      const float x = random.between(-0.2f, 1.2f), y = random.between(-0.2f, 1.2f);
      const auto& aimed = triangles[i % 2];
      ray.direction = normalize(aimed[0] + (x * (aimed[1] - aimed[0]) + y * (aimed[2] - aimed[0])) - ray.origin);
      const Expected e[2] = {meet(ray, triangles[0]), meet(ray, triangles[1])};
      const auto clear = [](double margin) { return std::abs(margin) > 1e-4; };
      if (!clear(e[0].margin) || !clear(e[1].margin) || std::min(e[0].cosine, e[1].cosine) < 0.01) continue;
      int nearest = -1, met = 0;
      for (int k = 0; k < 2; ++k)
        if (e[k].margin > 0 && e[k].t > 0) {
          ++met;
          if (nearest < 0 || e[k].t < e[nearest].t) nearest = k;
        }
      if (met == 2 && std::abs(e[0].t - e[1].t) < 1e-4) continue;  // folded onto each other: either one may be found

      Hit hit;
      ASSERT_EQ(scene->nearest(ray, hit), nearest >= 0) << "trial " << trial << " " << structure;
      EXPECT_EQ(scene->any(ray), nearest >= 0);
      HitList all;
      scene->all(ray, all);
      EXPECT_EQ(all.size, met);
      if (nearest < 0) continue;
      EXPECT_EQ(int(hit.primitive), nearest) << "trial " << trial;
      EXPECT_NEAR(double(hit.distance), e[nearest].t, 2e-6 / e[nearest].cosine) << structure;
      EXPECT_NEAR(double(hit.u), e[nearest].u, 1e-4 / e[nearest].cosine);
      EXPECT_NEAR(double(hit.v), e[nearest].v, 1e-4 / e[nearest].cosine);
      ray.maximum = float(e[nearest].t * 0.999);
      EXPECT_FALSE(scene->any(ray));
      EXPECT_FALSE(scene->nearest(ray, hit));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Pairs, testing::Values(Shape::convex, Shape::concave, Shape::bent, Shape::folded));

// On the edge that the two triangles of a pair share, from all sides, a ray hits one of them and only one.
TEST(PairsOfTriangles, HaveNothingBetweenThem) {
  Random random(12);
  const Ref<Scene> scene = ref_cast<Scene>(Registry::instance().create("BruteForceScene"));
  scene->objects = {
      object("TriangleMesh", {{"positions", {0, 0, 0, 1, 0, 0, 1.5, 1.25, 0, 0, 1, 0}}, {"triangles", {0, 1, 2, 0, 2, 3}}})};
  prepare_tree(*scene);
  for (int i = 0; i < 200000; ++i) {
    Ray ray;
    const float along = random.between(0.001f, 0.999f);
    const Vector3 from = random.direction();
    if (std::abs(from.z) < 0.02f) continue;
    const Point3 at{1.5f * along, 1.25f * along, 0};
    ray.origin = at + 3 * from;
    ray.direction = normalize(at - ray.origin);
    HitList all;
    scene->all(ray, all);
    ASSERT_EQ(all.size, 1) << i;
  }
}

}  // namespace
}  // namespace etendue
