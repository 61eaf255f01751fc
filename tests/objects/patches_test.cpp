// Bézier patches and NURBS surfaces: closed forms, roots that are easily missed, borders, trimming, errors.

#include "etendue/core/error.h"
#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

/// Distances of all hits along a ray; each is left by its point's error bound.
std::vector<float> crossings(const SceneObject& o, Ray r) {
  std::vector<float> found;
  const Point3 start = r.origin;
  for (Hit hit; found.size() < 100 && o.intersect(r, hit); hit = {}) {
    SurfacePoint p;
    o.surface_point(r, hit, p);
    found.push_back(dot(p.position - start, r.direction));
    p.leave(r.direction, r);
  }
  return found;
}

// ---- a torus: nine by nine points, rational of degree 2 (Piegl & Tiller 1997, example 8.4) ------------------------------

constexpr double major_radius = 1.25, minor_radius = 0.5;
const std::vector<double> circle_knots{0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1};
constexpr int circle_x[9]{1, 1, 0, -1, -1, -1, 0, 1, 1}, circle_y[9]{0, 1, 1, 1, 0, -1, -1, -1, 0};

std::vector<Setting> torus_settings(double scale = 1) {
  std::vector<double> points, weights;
  for (int j = 0; j < 9; ++j)      // around the axis
    for (int i = 0; i < 9; ++i) {  // around the tube
      const double r = scale * (major_radius + minor_radius * circle_x[i]);
      points.insert(points.end(), {r * circle_x[j], r * circle_y[j], scale * minor_radius * circle_y[i]});
      weights.push_back((i % 2 ? std::sqrt(0.5) : 1) * (j % 2 ? std::sqrt(0.5) : 1));
    }
  return {{"degree_u", 2.0},         {"degree_v", 2.0},  {"knots_u", circle_knots},
          {"knots_v", circle_knots}, {"points", points}, {"weights", weights}};
}

/// The torus' roots with t > 0: (|p|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2), by sign changes in fine steps and bisection.
std::vector<double> torus_roots(const Ray& r) {
  const auto f = [&](double t) {
    const double x = double(r.origin.x) + t * double(r.direction.x), y = double(r.origin.y) + t * double(r.direction.y),
                 z = double(r.origin.z) + t * double(r.direction.z);
    const double ring = std::sqrt(x * x + y * y) - major_radius;
    return ring * ring + z * z - minor_radius * minor_radius;
  };
  std::vector<double> roots;
  constexpr double step = 0.004;
  for (double t = 0; t < 10; t += step) {
    if ((f(t) < 0) == (f(t + step) < 0)) continue;
    double low = t, high = t + step;
    for (int i = 0; i < 50; ++i) {
      const double middle = (low + high) / 2;
      ((f(middle) < 0) == (f(low) < 0) ? low : high) = middle;
    }
    roots.push_back(low);
  }
  return roots;
}

TEST(NurbsSurface, TorusAgreesWithItsFormula) {
  const Ref<SceneObject> torus = object("NurbsSurface", torus_settings());
  EXPECT_TRUE(torus->closed());
  EXPECT_NEAR(torus->area(0), 4 * M_PI * M_PI * major_radius * minor_radius, 2e-5);
  EXPECT_LT(torus->area_error(0), 1e-5f);
  Random random(1);
  int odd = 0, hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Point3 origin = Point3{} + 4 * random.direction();
    const Ray r = ray(origin, normalize(random.in_box(1.2f) - origin));
    const std::vector<double> expected = torus_roots(r);
    const std::vector<float> found = crossings(*torus, r);
    if (found.size() != expected.size()) {  // only rays that touch, whose roots the steps do not separate
      ++odd;
      continue;
    }
    for (size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(double(found[k]), expected[k], 4e-5);
    hits += int(found.size());
    Hit hit;
    if (!torus->intersect(r, hit)) continue;
    SurfacePoint p;
    torus->surface_point(r, hit, p);
    const float ring = std::hypot(p.position.x, p.position.y);
    const Vector3 n{p.position.x * (1 - float(major_radius) / ring), p.position.y * (1 - float(major_radius) / ring),
                    p.position.z};
    EXPECT_GT(dot(p.normal, normalize(n)), 1 - 1e-6f);  // outwards
  }
  EXPECT_GT(hits, 3000);
  EXPECT_LE(odd, 4);
}

TEST(NurbsSurface, HoldsFromMillimetresToKilometresAndMirrored) {
  for (const double scale : {1e-3, 1.0, 1e5}) {
    SCOPED_TRACE(scale);
    const float size = float(scale);
    const Ref<SceneObject> torus = object("NurbsSurface", torus_settings(scale), Transform::scale({1, -1, 1}));
    Random random(2);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
      const Point3 origin = Point3{} + 4 * size * random.direction();
      const std::vector<float> found = crossings(*torus, ray(origin, normalize(random.in_box(size) - origin)));
      inside += found.size() % 2 == 1;
      for (size_t k = 1; k < found.size(); ++k) EXPECT_GT(found[k], found[k - 1]);
    }
    EXPECT_LE(inside, 1);  // pairs, except for a ray that touches
    EXPECT_NEAR(double(torus->area(0)) / (scale * scale), 4 * M_PI * M_PI * major_radius * minor_radius, 1e-4);
  }
}

TEST(NurbsSurface, KnotsWithinDoNotChangeTheSurface) {
  // z = u v on [0, 3] x [0, 2] with knots that are neither even nor repeated at the ends: the control points are values of the
  // blossom.
  const std::vector<double> ku{-2, -1, 0, 0.7, 2, 3, 3.5, 5}, kv{-1, 0, 0.4, 0.9, 2, 4};  // degrees 2 and 1
  std::vector<double> points;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 5; ++i) {
      const double u = (ku[size_t(i) + 1] + ku[size_t(i) + 2]) / 2, v = kv[size_t(j) + 1];
      points.insert(points.end(), {u, v, u * v});
    }
  const Ref<SceneObject> sheet =
      object("NurbsSurface", {{"degree_u", 2.0}, {"degree_v", 1.0}, {"knots_u", ku}, {"knots_v", kv}, {"points", points}});
  EXPECT_FALSE(sheet->closed());
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const float u = random.between(0, 3), v = random.between(0, 2);
    Hit hit;
    ASSERT_TRUE(sheet->intersect(ray({u, v, 10}, {0, 0, -1}), hit)) << u << ' ' << v;
    EXPECT_NEAR(hit.distance, 10 - u * v, 2e-6f);
    SurfacePoint p;
    sheet->surface_point(ray({u, v, 10}, {0, 0, -1}), hit, p);
    EXPECT_NEAR(p.uv.x, u / 3, 1e-6f);
    EXPECT_NEAR(p.uv.y, v / 2, 1e-6f);
    EXPECT_LT(length(p.dpdu - Vector3{3, 0, 3 * v}), 1e-5f);
    EXPECT_LT(length(p.dpdv - Vector3{0, 2, 2 * u}), 1e-5f);
  }
}

// ---- trimming -------------------------------------------------------------------------------------------------------------

std::vector<Setting> square_settings() {  // the unit square, in four pieces
  return {{"degree_u", 1.0},
          {"degree_v", 1.0},
          {"knots_u", {0, 0, 0.4, 1, 1}},
          {"knots_v", {0, 0, 0.7, 1, 1}},
          {"points", {0, 0, 0, 0.4, 0, 0, 1, 0, 0, 0, 0.7, 0, 0.4, 0.7, 0, 1, 0.7, 0, 0, 1, 0, 0.4, 1, 0, 1, 1, 0}}};
}

Ref<SceneObject> trimmed(double radius, const std::string& keep) {
  Ref<SceneObject> made = ref_cast<SceneObject>(Registry::instance().create("NurbsSurface"));
  for (const Setting& s : square_settings()) set(*made, s.member, s.value);
  std::vector<double> points, weights;
  for (int i = 0; i < 9; ++i) {
    points.insert(points.end(), {0.5 + radius * circle_x[i], 0.5 + radius * circle_y[i]});
    weights.push_back(i % 2 ? std::sqrt(0.5) : 1);
  }
  const Ref<Component> circle = Registry::instance().create("TrimmingCurve");
  for (const Setting& s : {Setting{"degree", 2.0}, {"knots", circle_knots}, {"points", points}, {"weights", weights}})
    set(*circle, s.member, s.value);
  set(*made, "trimming", Value(Value::List{Value(circle)}));
  set(*made, "keep", Value(keep));
  prepare_tree(*made);
  return made;
}

TEST(NurbsSurface, TrimmedByACircle) {
  const float radius = 0.35f;
  for (const std::string keep : {"inside", "outside"}) {
    SCOPED_TRACE(keep);
    const Ref<SceneObject> o = trimmed(double(radius), keep);
    const double disc = M_PI * double(radius) * double(radius), area = keep == "inside" ? disc : 1 - disc;
    EXPECT_NEAR(double(o->area(0)), area, 1e-5);
    Random random(4);
    Mean found;
    for (int i = 0; i < 20000; ++i) {
      const Point2 at = random.pair();
      const float from_edge = std::hypot(at.x - 0.5f, at.y - 0.5f) - radius;
      Hit hit;
      const bool met = o->intersect(ray({at.x, at.y, 1}, {0, 0, -1}), hit);
      EXPECT_TRUE(std::abs(from_edge) < 1e-5f || met == ((from_edge < 0) == (keep == "inside"))) << from_edge;
      const SurfaceSample s = o->sample_area(random.pair(), 0);
      ASSERT_GT(s.pdf, 0);
      const float off = std::hypot(s.point.position.x - 0.5f, s.point.position.y - 0.5f) - radius;
      EXPECT_TRUE(keep == "inside" ? off < 1e-5f : off > -1e-5f);
      found.add(double(s.point.position.x > 0.7f));
    }
    // The fraction of points with x > 0.7: a segment of the disc. 5 standard errors.
    const double h = 0.2 / double(radius);
    const double segment = double(radius) * double(radius) * (std::acos(h) - h * std::sqrt(1 - h * h));
    EXPECT_NEAR(found.value(), (keep == "inside" ? segment : 0.3 - segment) / area, 5 * found.error());
  }
}

// ---- Bézier patches -------------------------------------------------------------------------------------------------------

/// z = x^3 - x / 3 over [-1, 1]^2 as one patch, which horizontal rays can hit three times.
std::vector<Setting> wave_settings() {
  std::vector<double> points;
  const double z[4]{-2.0 / 3, 10.0 / 9, -10.0 / 9, 2.0 / 3};
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) points.insert(points.end(), {-1 + 2 * i / 3.0, -1 + 2 * j / 3.0, z[i]});
  return {{"points", points}};
}

TEST(BezierPatches, FindsAllRootsOfRaysThatGraze) {
  const Ref<SceneObject> wave = object("BezierPatches", wave_settings());
  Random random(5);
  // Horizontal rays hit it three times below the crest, x^3 - x / 3 = 2 / 27 at x = -1 / 3, and once above.
  const double top = 2.0 / 27;
  for (int i = 0; i < 2000; ++i) {
    const double close = std::pow(10.0, -5 * double(random.number()));  // down to 1e-5 of the crest
    for (const double side : {1 - close, 1 + close}) {
      const float h = float(top * side), y = random.between(-0.9f, 0.9f);
      const std::vector<float> found = crossings(*wave, ray({-2, y, h}, {1, 0, 0}));
      ASSERT_EQ(found.size(), double(h) < top ? 3u : 1u) << h;
      for (const float t : found) {
        const double x = double(t) - 2;
        EXPECT_NEAR(x * x * x - x / 3, double(h), 1e-6);
      }
    }
  }
}

TEST(BezierPatches, EveryRayThroughAClosedBodyLeavesIt) {
  // A ball of octants (each a triangle, a patch with one edge shrunk to a point), rational of degree 2: exact.
  std::vector<double> points, weights;
  const double w = std::sqrt(0.5);
  for (int south = 0; south < 2; ++south)
    for (int quarter = 0; quarter < 4; ++quarter)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          const int a = 2 * quarter + i;
          const double r = j == 2 ? 0 : 1, z = (j == 0 ? 0 : 1) * (south ? -1 : 1);
          points.insert(points.end(), {r * circle_x[a], r * circle_y[a], z});
          weights.push_back((i == 1 ? w : 1) * (j == 1 ? w : 1));
        }
  const Ref<SceneObject> ball =
      object("BezierPatches", {{"degree_u", 2.0}, {"degree_v", 2.0}, {"points", points}, {"weights", weights}});
  EXPECT_TRUE(ball->closed());
  EXPECT_NEAR(ball->area(0), 4 * M_PI, 1e-4);
  Random random(6);
  for (int i = 0; i < 20000; ++i) {
    // Many of the rays go through borders and poles.
    const Point3 axis{i % 3 == 0 ? 0.0f : random.between(-0.4f, 0.4f), i % 3 == 1 ? 0.0f : random.between(-0.4f, 0.4f), 0};
    const Vector3 d = i % 2 ? Vector3{0, 0, 1} : random.direction();
    const Ray r = ray(axis - 3 * d, d);
    const std::vector<float> found = crossings(*ball, r);
    ASSERT_EQ(found.size(), 2u) << axis.x << ' ' << axis.y;
    Hit hit;
    ASSERT_TRUE(ball->intersect(r, hit));
    SurfacePoint p;
    ball->surface_point(r, hit, p);
    EXPECT_NEAR(length(p.position - Point3{}), 1, 1e-6f);
    EXPECT_GT(dot(p.normal, p.position - Point3{}), 1 - 1e-5f);  // outwards, at the poles too
  }
}

TEST(Patches, BadShapesAreErrorsThatNameTheMember) {
  const auto fault = [](const std::string& name, std::vector<Setting> settings, const Setting& bad) {
    std::erase_if(settings, [&](const Setting& s) { return s.member == bad.member; });
    settings.push_back(bad);
    try {
      object(name, settings);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(fault("NurbsSurface", square_settings(), {"knots_u", {0, 0, 0.4, 1}}), "points");
  expect(fault("NurbsSurface", square_settings(), {"knots_u", {0, 0, 0.4, 0.3, 1}}), "knot 3 is less");
  expect(fault("NurbsSurface", square_settings(), {"knots_v", {0, 0, 0, 0, 0}}), "knot");
  expect(fault("NurbsSurface", square_settings(), {"weights", {1, 1}}), "2 weights for 9 points");
  expect(fault("BezierPatches", wave_settings(), {"patches", {0, 1, 2}}), "16 points make a patch");
  expect(fault("BezierPatches", wave_settings(), {"patches", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 99}}),
         "point 99 of 16");
  expect(fault("BezierPatches", {}, {"points", std::vector<double>(48, 1.0)}), "no area");
}

}  // namespace
}  // namespace etendue
