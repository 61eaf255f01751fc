// Transforms and shapes: areas, points on surfaces, sampling.

#include "support/component_test_support.h"
#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

float largest_difference(const Transform& a, const Transform& b) {
  float d = 0;
  for (size_t i = 0; i < 12; ++i) d = std::max(d, std::abs(a.matrix()[i] - b.matrix()[i]));
  return d;
}

TEST(Transform, InverseUndoes) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Transform t = random.placement(10, 0.1f, 5) * Transform::scale({1, random.between(0.3f, 2), -2});
    EXPECT_TRUE(t.valid());
    EXPECT_TRUE(t.flips());
    EXPECT_LT(largest_difference(t * t.inverse(), Transform()), 2e-4f);
    const Point3 p = random.in_box(5);
    EXPECT_LT(distance(t.back(t(p)), p), 1e-3f);
    // A normal stays perpendicular to the tangents that it was perpendicular to.
    const Normal3 n(random.direction());
    const Frame f(n);
    EXPECT_NEAR(dot(normalize(t(n)), normalize(t(f.s))), 0, 1e-4f);
  }
}

TEST(Transform, SingularIsNotValid) {
  EXPECT_FALSE(Transform(Transform::Matrix{1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0}).valid());
  EXPECT_FALSE(Transform::scale({1, 0, 1}).valid());
  EXPECT_FALSE(Transform::scale({1, infinity, 1}).valid());
  EXPECT_FALSE(Transform::look_at({1, 2, 3}, {1, 2, 3}, {0, 1, 0}).valid());
  EXPECT_FALSE(Transform::look_at({0, 0, 0}, {0, 3, 0}, {0, 1, 0}).valid());
  EXPECT_TRUE(Transform::scale({1e-6f, 1e-6f, 1e-6f}).valid());
  EXPECT_TRUE(Transform().identity());
  EXPECT_FALSE(Transform::scale({1, 1, 2}).identity());
}

TEST(Transform, LookAtFrame) {
  const Transform t = Transform::look_at({1, 2, 3}, {1, 2, 8}, {0, 1, 0});
  EXPECT_LT(distance(t(Point3{0, 0, 0}), {1, 2, 3}), 1e-6f);
  EXPECT_LT(length(t(Vector3{0, 0, 1}) - Vector3{0, 0, 1}), 1e-6f);
  EXPECT_LT(length(t(Vector3{0, 1, 0}) - Vector3{0, 1, 0}), 1e-6f);
  EXPECT_LT(length(t(Vector3{1, 0, 0}) - Vector3{1, 0, 0}), 1e-6f);  // looking along +z with y up, +x is on the left
  EXPECT_FALSE(Transform::look_at({3, 1, 2}, {-1, 4, 0}, {0.1f, 1, 0}).flips());
}

TEST(Transform, ErrorBoundHolds) {
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const Transform t = random.placement(1000, 0.1f, 10);
    const Point3 p = random.in_box(100), q = t(p);
    const Vector3 bound = t.error_bound(p);
    for (size_t r = 0; r < 3; ++r) {
      double exact = t.matrix()[4 * r + 3];
      for (int k = 0; k < 3; ++k) exact += double(t.matrix()[4 * r + size_t(k)]) * p[k];
      EXPECT_LE(std::abs(exact - q[int(r)]), bound[int(r)]);
    }
  }
}

TEST(AnimatedTransform, RotationKeepsSize) {
  const AnimatedTransform a(
      {{0, Transform::translate({1, 0, 0}) * Transform::scale({2, 2, 2})},
       {1, Transform::translate({5, 0, 0}) * Transform::rotate(2.5f, {1, 2, 3}) * Transform::scale({2, 2, 2})}});
  for (float time = 0; time <= 1; time += 0.01f) {
    const Transform t = a.at(time);
    EXPECT_NEAR(length(t(Vector3{1, 0, 0})), 2, 1e-5f);
    EXPECT_NEAR(length(t(Vector3{0.6f, 0, 0.8f})), 2, 1e-5f);
    EXPECT_NEAR(t(Point3{0, 0, 0}).x, 1 + 4 * time, 1e-5f);
  }
  EXPECT_EQ(a.at(-3), a.keys()[0].transform);
  EXPECT_EQ(a.at(7), a.keys()[1].transform);
  // Half way between the keys the rotation has half the angle.
  const Transform half = Transform::translate({3, 0, 0}) * Transform::rotate(1.25f, {1, 2, 3}) * Transform::scale({2, 2, 2});
  EXPECT_LT(largest_difference(a.at(0.5f), half), 1e-5f);
  EXPECT_THROW(AnimatedTransform({{1, {}}, {1, {}}}), Error);
  EXPECT_FALSE(AnimatedTransform({{0, {}}, {1, Transform::scale({-1, 1, 1})}}).valid());
}

TEST(AnimatedTransform, SweepHoldsAllPositions) {
  const AnimatedTransform a({{0, {}},
                             {1, Transform::translate({5, 1, 0}) * Transform::rotate(3, {0, 1, 0})},
                             {1.5f, Transform::translate({0, -4, 0})}});
  Bounds3 box;
  box.add(Point3{-1, -1, -2});
  box.add(Point3{1, 1, 2});
  const Bounds3 all = a.sweep(box, 0, 1.5f);
  for (float time = 0; time <= 1.5f; time += 0.0037f)
    for (int c = 0; c < 8; ++c) {
      const Point3 p = a.at(time)(box.corner(c));
      for (int k = 0; k < 3; ++k) {
        EXPECT_GE(p[k], all.low[k]);
        EXPECT_LE(p[k], all.high[k]);
      }
    }
  EXPECT_LT(length(all.diagonal()), 20);
}

TEST(Objects, Areas) {
  const Transform place = Transform::translate({3, -2, 1}) * Transform::rotate(1, {1, 1, 0}) * Transform::scale({2, 2, 2});
  EXPECT_NEAR(object("Sphere", {{"radius", 3}})->area(0), 36 * pi, 1e-3f);
  EXPECT_NEAR(object("Sphere", {{"radius", 3}}, place)->area(0), 144 * pi, 4e-3f);
  // A prolate spheroid with half axes 1, 1, c: 2 pi (1 + c / e asin(e)), e^2 = 1 - 1/c^2.
  const float c = 2.5f, e = std::sqrt(1 - 1 / (c * c));
  EXPECT_NEAR(object("Sphere", {}, Transform::scale({1, 1, c}))->area(0), 2 * pi * (1 + c / e * std::asin(e)), 5e-3f);
  EXPECT_NEAR(object("Disc", {{"radius", 2}}, place)->area(0), 16 * pi, 1e-3f);
  EXPECT_NEAR(object("Disc", {}, Transform::scale({3, 0.5f, 7}))->area(0), 1.5f * pi, 1e-5f);
  EXPECT_NEAR(object("Rectangle", {}, place)->area(0), 4, 1e-5f);
  EXPECT_NEAR(object("Rectangle", {{"edge_v", {1, 1, 0}}})->area(0), 1, 1e-6f);
  EXPECT_NEAR(object("Polygon", l_shape_settings(), place)->area(0), 12, 1e-4f);
  EXPECT_NEAR(object("TriangleMesh", cube_settings(), place)->area(0), 96, 1e-3f);
  const AnimatedTransform moving({{0, {}}, {1, Transform::scale({3, 3, 3})}});
  EXPECT_NEAR(object("TriangleMesh", cube_settings(), moving)->area(0.5f), 96, 1e-3f);
  EXPECT_NEAR(object("Sphere", {}, moving)->area(1), 36 * pi, 1e-3f);
}

TEST(Objects, HostileMembersAreRefused) {
  EXPECT_THROW(object("Polygon", {{"points", {0, 0, 0, 1, 0, 0}}}), Error);                              // two points
  EXPECT_THROW(object("Polygon", {{"points", {0, 0, 0, 1, 0, 0, 2, 0, 0}}}), Error);                     // no area
  EXPECT_THROW(object("Polygon", {{"points", {0, 0, 0, 1, 0, 0, 1, 1, 0.1, 0, 1, 0}}}), Error);          // not planar
  EXPECT_THROW(object("Polygon", {{"points", {0, 0, 0, 4, 0, 0, 4, 3, 0, 1, -1, 0, 0, 3, 0}}}), Error);  // crosses itself
  EXPECT_NO_THROW(object("Polygon", {{"points", {0, 0, 0, 1, 0, 0, 1, 1, 1e-5, 0, 1, 0}}}));
  EXPECT_THROW(object("Rectangle", {{"edge_v", {2, 0, 0}}}), Error);
  EXPECT_THROW(object("Sphere", {{"radius", 0}}), Error);
  EXPECT_THROW(object("Environment", {}, Transform::scale({1, 2, 1})), Error);
}

TEST(Objects, ConcavePolygonIsFilledOnce) {
  // A star with a dent, straight corners and a point on an edge: hits must agree with the even-odd rule.
  Random random(7);
  std::vector<double> points;
  std::vector<Point2> outline;
  for (int i = 0; i < 40; ++i) {
    const double a = 2 * double(pi) * i / 40, r = (i % 2) ? 1 + 0.05 * i : 2 + 0.3 * (i % 3);
    points.insert(points.end(), {r * std::cos(a), r * std::sin(a), 0});
    outline.push_back({float(r * std::cos(a)), float(r * std::sin(a))});
  }
  const Ref<SceneObject> polygon = object("Polygon", {{"points", points}});
  int differ = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point2 p{random.between(-4, 4), random.between(-4, 4)};
    bool inside = false;
    for (size_t k = 0; k < outline.size(); ++k) {
      const Point2 a = outline[k], b = outline[(k + 1) % outline.size()];
      if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
    Hit hit;
    differ += polygon->intersect(ray({p.x, p.y, 5}, {0, 0, -1}), hit) != inside;
  }
  EXPECT_LE(differ, 2);  // on an edge
}

// ---- closed forms: irradiance from luminaires of radiance 1 --------------------------------------------------------------

/// One sample of the irradiance at a point with a normal, from the front of a luminaire.
double irradiance(const SceneObject& light, const Point3& at, const Normal3& normal, Point2 u) {
  const SurfaceSample s = light.sample_visible(at, u, 0);
  const float here = dot(normal, s.direction), there = -dot(s.point.normal, s.direction);
  return s.pdf > 0 && here > 0 && there > 0 ? double(here) / double(s.pdf) : 0;
}

/// The form factor from one surface to another: mean irradiance over the receiver, over pi.
double form_factor(const SceneObject& receiver, const SceneObject& light, int samples) {
  Random random(11);
  Mean mean;
  for (int i = 0; i < samples; ++i) {
    const SurfaceSample s = receiver.sample_area(random.pair(), 0);
    mean.add(irradiance(light, s.point.position, s.point.normal, random.pair()));
  }
  return mean.value() / double(pi);
}

const std::vector<Setting> square_mesh{{"positions", {-0.5, -0.5, 0, 0.5, -0.5, 0, 0.5, 0.5, 0, -0.5, 0.5, 0}},
                                       {"triangles", {0, 1, 2, 0, 2, 3}}};

TEST(ClosedForm, ParallelSquares) {
  const Transform above = Transform::translate({0, 0, 1}) * Transform::rotate(pi, {1, 0, 0});
  EXPECT_NEAR(form_factor(*object("Rectangle"), *object("Rectangle", {}, above), 100000) / 0.199825, 1, 5e-3);
  EXPECT_NEAR(form_factor(*object("Rectangle"), *object("TriangleMesh", square_mesh, above), 100000) / 0.199825, 1, 5e-3);
  EXPECT_NEAR(form_factor(*object("Rectangle"), *object("Polygon", {}, above), 100000) / 0.199825, 1, 5e-3);
}

TEST(ClosedForm, PerpendicularSquares) {
  const Ref<SceneObject> floor = object("Rectangle", {{"corner", {0, 0, 0}}}),
                         wall = object("Rectangle", {{"corner", {0, 0, 0}}, {"edge_u", {0, 1, 0}}, {"edge_v", {0, 0, 1}}});
  EXPECT_NEAR(form_factor(*floor, *wall, 200000) / 0.200044, 1, 5e-3);
}

// Polar surface coordinates: (x, y) = radius u (cos 2 pi v, sin 2 pi v), and tangents that are its derivatives.
TEST(Disc, PolarCoordinates) {
  const Ref<SceneObject> disc = test::create<SceneObject>("Disc", {{"radius", 2.0}, {"coordinates", "polar"}});
  for (const auto& [x, y] : {std::pair{0.6f, 0.0f}, {0.0f, 1.0f}, {-0.9f, 0.7f}, {0.3f, -1.6f}, {-0.01f, -0.02f}}) {
    Ray ray;
    ray.origin = {x, y, 1};
    ray.direction = {0, 0, -1};
    Hit hit;
    ASSERT_TRUE(disc->intersect(ray, hit));
    SurfacePoint p;
    disc->surface_point(ray, hit, p);
    disc->tangents(p);
    const double u = double(p.uv.x), v = 2 * M_PI * double(p.uv.y);
    EXPECT_GE(p.uv.y, 0);
    EXPECT_LT(p.uv.y, 1);
    EXPECT_NEAR(2 * u * std::cos(v), double(x), 1e-5);
    EXPECT_NEAR(2 * u * std::sin(v), double(y), 1e-5);
    EXPECT_LT(length(p.dpdu - Vector3{float(2 * std::cos(v)), float(2 * std::sin(v)), 0}), 1e-4f);
    EXPECT_LT(length(p.dpdv - Vector3{float(-4 * M_PI * u * std::sin(v)), float(4 * M_PI * u * std::cos(v)), 0}), 1e-4f);
  }
}

TEST(ClosedForm, CoaxialDiscs) {
  const Ref<SceneObject> other = object("Disc", {}, Transform::translate({0, 0, 1}) * Transform::rotate(pi, {0, 1, 0}));
  EXPECT_NEAR(form_factor(*object("Disc"), *other, 200000) / ((3 - std::sqrt(5.0)) / 2), 1, 5e-3);
}

double point_irradiance(const SceneObject& light, const Point3& at, const Normal3& normal, int samples) {
  Random random(12);
  Mean mean;
  for (int i = 0; i < samples; ++i) mean.add(irradiance(light, at, normal, random.pair()));
  return mean.value();
}

TEST(ClosedForm, RectangleAbovePoint) {
  const Transform down = Transform::translate({0, 0, 1}) * Transform::rotate(pi, {1, 0, 0}) * Transform::scale({2, 2, 2});
  EXPECT_NEAR(point_irradiance(*object("Rectangle", {}, down), {0, 0, 0}, {0, 0, 1}, 50000) / 1.740840, 1, 5e-3);
  EXPECT_NEAR(point_irradiance(*object("TriangleMesh", square_mesh, down), {0, 0, 0}, {0, 0, 1}, 50000) / 1.740840, 1, 5e-3);
  const AnimatedTransform moving({{0, down}, {1, Transform::rotate(1, {0, 1, 0}) * down}});
  EXPECT_NEAR(point_irradiance(*object("Rectangle", {}, moving), {0, 0, 0}, {0, 0, 1}, 50000) / 1.740840, 1, 5e-3);
}

TEST(ClosedForm, SphereAboveAndHalfBelowTheHorizon) {
  const Ref<SceneObject> sphere = object("Sphere", {}, Transform::translate({3, 0, 0}));
  EXPECT_NEAR(point_irradiance(*sphere, {0, 0, 0}, {1, 0, 0}, 20000) / (double(pi) / 9), 1, 5e-3);
  EXPECT_NEAR(point_irradiance(*sphere, {0, 0, 0}, {0, 0, 1}, 200000) / (std::atan(1 / std::sqrt(8.0)) - std::sqrt(8.0) / 9), 1,
              5e-3);
}

// ---- rays leave surfaces
// ------------------------------------------------------------------------------------------------------

/// Whether a ray hits anything, apart from an edge that it passes within rounding.
bool meets(const Scene& scene, const Ray& ray) {
  Hit hit;
  if (!scene.nearest(ray, hit)) return false;
  return hit.object->class_info().name != "TriangleMesh" || std::min({hit.u, hit.v, 1 - hit.u - hit.v}) > 1e-5f;
}

/// The number of rays that hit an object again after leaving its surface to a side on which nothing of the object lies.
int met_again(const SceneObject& object, const Scene& scene, bool both_sides, int rays, Random& random) {
  int met = 0;
  for (int i = 0; i < rays; ++i) {
    const float time = random.number();
    const SurfaceSample s = object.sample_area(random.pair(), time);
    Vector3 d = random.direction();
    if (!both_sides && dot(s.point.normal, d) < 0) d = -d;
    if (i % 4 == 0) d = normalize(d - (1 - 1e-4f) * dot(s.point.normal, d) * Vector3(s.point.normal));  // grazing
    if (std::abs(dot(s.point.normal, d)) < 1e-5f) continue;  // rounding may put it on either side
    met += meets(scene, s.point.leave(d));
    // The same from a point that was found by tracing a ray.
    const Ray in = ray(s.point.position + 3 * std::sqrt(object.area(time)) * d, -d, time);
    Hit hit;
    if (!scene.nearest(in, hit) || hit.object != &object) continue;
    SurfacePoint p;
    scene.locate(in, hit, p);
    // If rounding put the hit beside an edge, the point may lie just behind the next triangle.
    if (object.class_info().name == "TriangleMesh" && std::min({p.u, p.v, 1 - p.u - p.v}) < 1e-5f) continue;
    if (dot(p.normal, d) > 1e-5f) met += meets(scene, p.leave(d));
  }
  return met;
}

TEST(Objects, LeavingRaysDoNotReturn) {
  Random random(17);
  for (const char* structure : {"BruteForceScene", "EmbreeScene"})
    for (float size : {1e-3f, 1.0f, 1e5f})
      for (float away : {0.0f, 3.0f, 1000.0f}) {  // in multiples of the size
        SCOPED_TRACE(std::string(structure) + ", size " + std::to_string(size) + ", away " + std::to_string(away));
        const auto test = [&](const std::string& name, const std::vector<Setting>& settings, bool both_sides,
                              const AnimatedTransform& place) {
          const Ref<SceneObject> o = object(name, settings, place);
          EXPECT_EQ(met_again(*o, *scene(structure, {o}), both_sides, 400, random), 0) << name;
        };
        for (int i = 0; i < 6; ++i) {
          const Transform place = Transform::translate(away * size * random.direction()) *
                                  Transform::rotate(random.between(0, 6), random.direction()) *
                                  Transform::scale({size, size, size});
          const Transform there = Transform::translate(size * random.direction()) * place * Transform::rotate(1, {0, 1, 0});
          const AnimatedTransform moving({{0, place}, {1, there}});
          for (const AnimatedTransform& t : {AnimatedTransform(place), moving}) {
            test("Sphere", {{"centre", {0.2, 0, 0}}}, false, t);
            test("Disc", {}, true, t);
            test("Rectangle", {}, true, t);
            test("Polygon", l_shape_settings(), true, t);
            test("TriangleMesh", cube_settings(), false, t);
            std::vector<double> corners;
            for (int k = 0; k < 9; ++k) corners.push_back(double(random.between(-1, 1)));
            test("TriangleMesh", {{"positions", corners}, {"triangles", {0, 1, 2}}}, true, t);
          }
          test("Sphere", {}, false, place * Transform::scale({1, 0.5f, 2}));
        }
      }
}

TEST(Environment, SurroundsTheScene) {
  const Transform turn = Transform::rotate(0.8f, {1, 2, 0.5f});
  const Ref<SceneObject> e = object("Environment", {}, turn);
  EXPECT_TRUE(e->infinite());
  EXPECT_TRUE(e->bounds().empty());
  Random random(8);
  for (int i = 0; i < 2000; ++i) {
    const SurfaceSample s = e->sample_visible({1, 2, 3}, random.pair(), 0);
    EXPECT_TRUE(s.infinite);
    EXPECT_NEAR(s.pdf, 1 / (4 * pi), 1e-6f);
    EXPECT_EQ(e->visible_pdf({1, 2, 3}, s.direction, s.point), s.pdf);
    EXPECT_NEAR(dot(s.point.normal, s.direction), -1, 1e-5f);
    EXPECT_LT(length(turn(s.point.object_position - Point3{}) - s.direction), 1e-5f);
  }
  SurfacePoint p;
  e->surface_point(ray({0, 0, 0}, turn(Vector3{1, 0, 0})), {}, p);
  EXPECT_NEAR(p.uv.x, 0.25f, 1e-5f);
  EXPECT_NEAR(p.uv.y, 0.5f, 1e-5f);
  e->surface_point(ray({0, 0, 0}, turn(normalize(Vector3{0.001f, 1, 0}))), {}, p);
  EXPECT_GT(p.uv.y, 0.999f);
}

}  // namespace
}  // namespace etendue
