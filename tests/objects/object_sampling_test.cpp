// Points on shapes: found by rays, and sampled by area and by solid angle.

#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

// ---- all shapes, still, stretched, mirrored and moving ------------------------------------------------------------------

struct Case {
  std::string name;
  Ref<SceneObject> object;
  float time = 0;
};

std::vector<Case> cases() {
  const Transform place = Transform::translate({0.3f, -0.2f, 0.1f}) * Transform::rotate(0.7f, {1, 1, 0});
  const AnimatedTransform moving({{0, place}, {1, Transform::translate({0.5f, 0.5f, 0}) * Transform::rotate(2, {0, 1, 1})}});
  const Transform stretched = place * Transform::scale({1.5f, 0.7f, 1}), mirrored = place * Transform::scale({-1, 1, 1});
  const AnimatedTransform mirrored_moving(
      {{0, stretched * Transform::scale({1, -1, 1})}, {1, Transform::rotate(1, {1, 0, 0}) * mirrored}});
  const std::vector<Setting> slanted{{"corner", {-0.5, -0.5, 0}}, {"edge_u", {1, 0, 0}}, {"edge_v", {0.5, 1, 0}}};
  std::vector<Case> list;
  const auto add = [&](const std::string& what, const std::vector<Setting>& settings) {
    list.push_back({what, object(what, settings), 0});
    list.push_back({what + " placed", object(what, settings, place), 0});
    list.push_back({what + " stretched", object(what, settings, stretched), 0});
    list.push_back({what + " mirrored", object(what, settings, mirrored), 0});
    list.push_back({what + " moving", object(what, settings, moving), 0.4f});
    list.push_back({what + " moving mirrored", object(what, settings, mirrored_moving), 0.7f});
  };
  add("Sphere", {{"radius", 0.8}, {"centre", {0.1, 0, 0}}});
  add("Disc", {});
  add("Rectangle", {});
  add("Rectangle", slanted);
  add("Polygon", l_shape_settings());
  add("TriangleMesh", cube_settings());
  return list;
}

TEST(Objects, SurfacePointsAgreeWithRays) {
  Random random(3);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
      const Point3 origin = random.in_box(3);
      const Ray r = ray(origin, normalize(random.in_box(1) - origin), c.time);
      Hit hit;
      if (!c.object->intersect(r, hit)) {
        EXPECT_FALSE(c.object->occludes(r));
        continue;
      }
      ++hits;
      EXPECT_TRUE(c.object->occludes(r));
      ASSERT_EQ(hit.object, c.object.get());
      SurfacePoint p;
      c.object->surface_point(r, hit, p);
      EXPECT_LT(distance(p.position, r(hit.distance)), 2e-5f);
      EXPECT_NEAR(length(Vector3(p.normal)), 1, 1e-5f);
      EXPECT_GE(dot(p.normal, p.shading_normal), 0);
      const Transform t = c.object->transform.from_origin(c.time);
      EXPECT_LT(distance(t(p.object_position), p.position), 2e-5f);
      EXPECT_NEAR(dot(normalize(t(p.object_normal)), p.normal), 1, 1e-4f);
      EXPECT_EQ(p.time, c.time);
      // Tangents: p(u + h, v) is found by a second ray towards the point that the tangent predicts.
      c.object->tangents(p);
      EXPECT_NEAR(dot(p.normal, normalize(p.dpdu)), 0, 1e-3f);
      EXPECT_NEAR(dot(p.normal, normalize(p.dpdv)), 0, 1e-3f);
      const float h = 2e-3f;
      const Point3 aside = p.position + h * p.dpdu;
      const Ray second = ray(aside + 0.01f * Vector3(p.normal), Vector3(-p.normal), c.time);
      Hit hit2;
      SurfacePoint p2;
      if (!c.object->intersect(second, hit2) || hit2.primitive != hit.primitive || hit2.distance > 0.02f) continue;
      c.object->surface_point(second, hit2, p2);
      float du = p2.uv.x - p.uv.x;
      du -= std::round(du);
      if (c.name.starts_with("Sphere") && (p.uv.y < 0.1f || p.uv.y > 0.9f)) continue;  // u is ill-conditioned near the poles
      EXPECT_NEAR(du, h, 0.1f * h);
      EXPECT_NEAR(p2.uv.y, p.uv.y, 0.1f * h);
    }
    EXPECT_GT(hits, 100);
    const Bounds3 box = c.object->bounds();
    for (int i = 0; i < 1000; ++i) {
      const SurfaceSample s = c.object->sample_area(random.pair(), c.time);
      for (int k = 0; k < 3; ++k) {
        EXPECT_GE(s.point.position[k], box.low[k] - 1e-6f);
        EXPECT_LE(s.point.position[k], box.high[k] + 1e-6f);
      }
    }
  }
}

// A point with the barycentric weights 0.3, 0.2 and 0.5 has a normal that is the mean of the corners' normals with these
// weights.
TEST(Objects, NormalsOfCornersAreInterpolated) {
  const Ref<SceneObject> mesh = object("TriangleMesh", {{"positions", {0, 0, 0, 4, 0, 0, 0, 4, 0}},
                                                        {"normals", {0, 0, 1, 0.6, 0, 0.8, 0, 0.28, 0.96}},
                                                        {"triangles", {0, 1, 2}}});
  const Ray down = ray({0.8f, 2, 1}, {0, 0, -1});
  Hit hit;
  ASSERT_TRUE(mesh->intersect(down, hit));
  SurfacePoint p;
  mesh->surface_point(down, hit, p);
  const Vector3 expected = normalize(Vector3{0.2f * 0.6f, 0.5f * 0.28f, 0.3f + 0.2f * 0.8f + 0.5f * 0.96f});
  EXPECT_LT(length(Vector3(p.shading_normal) - expected), 1e-5f);
}

TEST(Objects, AreaSamplingMatchesItsDensity) {
  // The mean of 1 / pdf is the area; the mean of position / pdf is its first moment, compared with hits of parallel rays (which
  // hit each piece of area in proportion to its cosine). 5 standard errors.
  Random random(4);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    Mean area;
    for (int i = 0; i < 20000; ++i) {
      const SurfaceSample s = c.object->sample_area(random.pair(), c.time);
      ASSERT_GT(s.pdf, 0);
      ASSERT_EQ(s.point.object, c.object.get());
      EXPECT_NEAR(c.object->area_pdf(s.point) / s.pdf, 1, 1e-4f);
      area.add(1 / double(s.pdf));
    }
    EXPECT_NEAR(area.value(), c.object->area(c.time), 5 * area.error() + 1e-4 * area.value());
  }
}

// For surfaces whose points by area are uniform, the mean of x^2 + y^2 and that of z^2 have closed forms; by the midpoint rule
// over the unit square.
TEST(Objects, PointsLieEvenly) {
  const struct {
    const char* shape;
    std::vector<Setting> settings;
    double around, along;
  } expected[] = {
      {"Disc", {{"radius", 3}}, 9 / 2.0, 0},
      {"Annulus", {{"radius", 3}, {"inner_radius", 1}}, (9 + 1) / 2.0, 0},
      {"Annulus", {{"radius", 3}, {"inner_radius", 2}, {"sweep", 70}}, (9 + 4) / 2.0, 0},
      {"Sphere", {{"radius", 3}}, 2 * 9 / 3.0, 9 / 3.0},
      {"Rectangle", {{"corner", {-1, -2, 0}}, {"edge_u", {2, 0, 0}}, {"edge_v", {0, 4, 0}}}, 1 / 3.0 + 4 / 3.0, 0},
      // From z = -h/2 to h/2.
      {"Cylinder", {{"radius", 2}, {"height", 3}, {"caps", false}}, 4, 9 / 12.0},
      // A cone from radius a to b: with points uniform by area, the parameter t along its side has a pdf proportional to r = a
      // + (b - a) t.
      {"Cone", {{"radius", 3}, {"top_radius", 0}, {"height", 2}, {"caps", false}}, 9 / 2.0, 4 / 6.0},
      // q = 1 + 3 r^2 / 4 from 1 to 4 has a pdf proportional to sqrt(q); r^2 = 4 (q - 1) / 3 and z^2 = (q - 1)^2 / 3.
      {"Paraboloid", {{"radius", 2}, {"height", std::sqrt(3.0)}, {"cap", false}}, 232 / 105.0, 848 / 735.0},
      // The means of (R + r cos p)^2 and (r sin p)^2 with a pdf proportional to R + r cos p.
      {"Torus", {{"radius", 2}, {"tube_radius", 1}}, 4 + 3 / 2.0, 1 / 2.0},
  };
  constexpr int side = 256;
  for (const auto& e : expected) {
    SCOPED_TRACE(e.shape);
    const Ref<SceneObject> shape = object(e.shape, e.settings);
    double around = 0, along = 0;
    for (int i = 0; i < side * side; ++i) {
      const SurfaceSample s = shape->sample_area({(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side}, 0);
      const double x = double(s.point.position.x), y = double(s.point.position.y), z = double(s.point.position.z);
      around += (x * x + y * y) / (side * side);
      along += z * z / (side * side);
    }
    EXPECT_NEAR(around, e.around, 1e-3 * e.around);
    EXPECT_NEAR(along, e.along, 1e-3 * e.along + 1e-9);
  }
}

// For points that are not uniform, the mean of 1 / pdf is the area: of an oblate ellipsoid 2 pi (a^2 + c^2 / e artanh e), of a
// prolate one 2 pi (a^2 + a c / e asin e). Both are so flat or so long that their points do not come from uniform points of the
// unit sphere.
TEST(Objects, PointsOfEllipsoidsAddUpToTheirAreas) {
  const auto expect = [](double a, double c, double area) {
    const Ref<SceneObject> shape = object("Ellipsoid", {{"radii", {a, a, c}}});
    constexpr int side = 512;
    double sum = 0;
    for (int i = 0; i < side * side; ++i) {
      const SurfaceSample s = shape->sample_area({(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side}, 0);
      sum += 1 / double(s.pdf) / (side * side);
    }
    EXPECT_NEAR(sum / area, 1, 2e-3) << a << " " << c;
  };
  const auto e = [](double ratio) { return std::sqrt(1 - ratio * ratio); };
  expect(1, 0.2, 2 * M_PI * (1 + 0.04 / e(0.2) * std::atanh(e(0.2))));
  expect(1, 3, 2 * M_PI * (1 + 3 / e(1 / 3.0) * std::asin(e(1 / 3.0))));
}

/// All surface points of an object along a ray.
template <class F>
void for_all_hits(const SceneObject& object, Ray r, const F& call) {
  for (int i = 0; i < 16; ++i) {
    Hit hit;
    if (!object.intersect(r, hit)) return;
    SurfacePoint p;
    object.surface_point(r, hit, p);
    call(p);
    r.origin = p.position + (p.error + 1e-5f) * r.direction;
  }
}

TEST(Objects, VisibleSamplingMatchesItsDensity) {
  // Against uniform directions: the pdf integrates to one, and the integrals of its products with three functions of direction
  // agree with means over samples. 5 standard errors; fixed seeds.
  Random random(5);
  const Point3 places[] = {{0, 0, 2.5f}, {1.1f, 1.5f, 0.8f}, {-1.2f, 0.3f, -0.9f}, {0.35f, -0.15f, 0.45f}};
  int judged = 0;
  for (const Case& c : cases())
    for (const Point3& from : places) {
      SCOPED_TRACE(c.name + " seen from z = " + std::to_string(from.z));
      Mean sampled[3], integral[4];
      for (int i = 0; i < 12000; ++i) {
        const SurfaceSample s = c.object->sample_visible(from, random.pair(), c.time);
        if (s.pdf == 0) continue;
        ASSERT_TRUE(std::isfinite(s.pdf));
        EXPECT_LT(length(from + s.distance * s.direction - s.point.position), 1e-4f);
        EXPECT_NEAR(length(s.direction), 1, 1e-5f);
        if (std::abs(dot(s.point.normal, s.direction)) > 1e-3f) {
          EXPECT_NEAR(c.object->visible_pdf(from, s.direction, s.point) / s.pdf, 1, 1e-4f);
        }
        for (int k = 0; k < 3; ++k) sampled[k].add(double(s.direction[k]));
      }
      int hits = 0;
      for (int i = 0; i < 40000; ++i) {
        const Vector3 d = random.direction();
        double pdf = 0;
        for_all_hits(*c.object, ray(from, d, c.time), [&](const SurfacePoint& p) {
          ++hits;
          pdf += double(c.object->visible_pdf(from, d, p)) * 4 * double(pi);
        });
        for (int k = 0; k < 3; ++k) integral[k].add(pdf * double(d[k]));
        integral[3].add(pdf);
      }
      if (hits < 400) continue;  // seen edge-on: too few for a meaningful standard error
      ++judged;
      EXPECT_NEAR(integral[3].value(), 1, 5 * integral[3].error() + 1e-3);
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(sampled[k].value(), integral[k].value(), 5 * (sampled[k].error() + integral[k].error()) + 1e-3);
    }
  EXPECT_GE(judged, 100);
}

TEST(Objects, SolidAngleDensities) {
  // A unit square seen from a height h above its centre: 4 asin(1 / (1 + 4 h^2)). The sphere: 2 pi (1 - cos).
  const Ref<SceneObject> square = object("Rectangle"), sphere = object("Sphere"),
                         slanted = object("Rectangle", {{"edge_u", {1, 0, 0}}, {"edge_v", {1e-4, 1, 0}}});
  for (float h : {0.2f, 0.5f, 1.0f, 1.3f}) {
    const double omega = 4 * std::asin(1 / (1 + 4 * double(h) * h));
    EXPECT_NEAR(square->sample_visible({0, 0, h}, {0.3f, 0.6f}, 0).pdf * omega, 1, 2e-4) << h;
    Mean mean;
    Random random(6);
    for (int i = 0; i < 4000; ++i) mean.add(1 / double(slanted->sample_visible({0, 0, h}, random.pair(), 0).pdf));
    EXPECT_NEAR(mean.value() / omega, 1, 3e-3) << h;
  }
  for (double d : {1.2, 3.0, 1000.0}) {
    const double sine2 = 1 / (d * d), omega = 2 * double(pi) * sine2 / (1 + std::sqrt(1 - sine2));
    EXPECT_NEAR(sphere->sample_visible({float(d), 0, 0}, {0.3f, 0.6f}, 0).pdf * omega, 1, 1e-5) << d;
  }
}

}  // namespace
}  // namespace etendue
