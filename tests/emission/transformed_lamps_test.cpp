// Lamps of every round and flat shape under transforms that stretch, shear, mirror and move them: light that arrives, estimated
// by sample_visible() and by sample_area(), against rays in all directions that hit the lamp or miss it; areas against closed
// forms; directions against what a transform does to them.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/luminaire_test_support.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

struct Place {
  const char* name;
  const char* transform;
};
const std::vector<Place> places = {{"as it is", "scale(1)"},
                                   {"grown", "translate(0.2, -0.1, 0.3) * rotate(40, [1, 2, 0.5]) * scale(1.6)"},
                                   {"stretched", "rotate(70, [0.3, -1, 1]) * scale(1.7, 0.6, 1.2)"},
                                   {"mirrored", "translate(0.1, 0, 0) * rotate(25, \"x\") * scale(-0.9, 1.3, 0.7)"},
                                   {"sheared", "matrix(1, 0.6, 0, 0, 0, 1.2, 0.4, 0, -0.3, 0, 0.8, 0)"}};

const std::vector<const char*> shapes = {"Sphere { radius: 0.8, centre: [0.1, 0.2, 0]",
                                         "Disc { radius: 0.9",
                                         "Annulus { radius: 1, inner_radius: 0.4, sweep: 250",
                                         "Cone { radius: 0.9, top_radius: 0.3, height: 1.1",
                                         "Cone { radius: 0.9, top_radius: 0.5, height: 0.7, caps: false, sweep: 200",
                                         "Cylinder { radius: 0.6, height: 1.2",
                                         "Torus { radius: 0.7, tube_radius: 0.3",
                                         "Box { size: [1.2, 0.7, 0.9]",
                                         "Rectangle { corner: [-0.6, -0.4, 0], edge_u: [1.2, 0, 0], edge_v: [0, 0.9, 0]",
                                         "Rectangle { corner: [-0.6, -0.4, 0], edge_u: [1.2, 0.2, 0], edge_v: [0.5, 0.9, 0.3]",
                                         "TriangleMesh { positions: [[0, 0, 0], [1, 0, 0.2], [0, 1.1, 0], [-0.3, -0.2, 0.8]], "
                                         "triangles: [[0, 1, 2], [0, 3, 1], [0, 2, 3]]"};

Ref<SceneObject> lamp(const std::string& shape, const std::string& transform) {
  return prepared_as<SceneObject>(shape + ", transform: " + transform +
                                  ", emission: DiffuseEmission { radiance: 1, sides: both } }");
}

/// Whether no other part of the lamp occludes its point.
bool seen(const SceneObject& object, const Point3& from, const Vector3& direction, float distance) {
  Ray ray;
  ray.origin = from;
  ray.direction = direction;
  ray.maximum = distance * 0.9995f;
  Hit hit;
  return !object.intersect(ray, hit);
}

TEST(TransformedLamps, ArriveByPointsAsByRays) {
  for (const char* shape : shapes)
    for (const Place& place : places) {
      const Ref<SceneObject> object = lamp(shape, place.transform);
      const Bounds3 box = object->bounds();
      const Point3 middle = box.centre();
      const float radius = 0.5f * length(box.diagonal());
      for (const Vector3& way : {Vector3{0.4f, 0.7f, 1.1f}, {-1.6f, 0.3f, -0.4f}, {1.5f, -4.f, 2}}) {
        const Point3 from = middle + (1 + radius / 2) * way;
        const std::string where = std::string(shape) + ", " + place.name + " from " + std::to_string(way.z);
        const Vector3 normal = normalize(middle - from + Vector3{0.3f, 0.2f, -0.1f});
        const double d = double(length(middle - from));
        if (d < double(radius) * 1.02) continue;
        // Rays within the cone around the bounding sphere, on a spiral (Swinbank & Purser 2006).
        const Frame frame{Normal3(normalize(middle - from))};
        const double h_end = 1 - std::sqrt(1 - std::pow(double(radius) / d, 2));
        constexpr int rays = 60000;
        double expected = 0;
        Hit hit;
        for (int i = 0; i < rays; ++i) {
          const double h = h_end * (i + 0.5) / rays, r = std::sqrt(h * (2 - h)), phi = i * 2.399963229728653;
          Ray ray;
          ray.origin = from;
          ray.direction = frame.to_world({float(r * std::cos(phi)), float(r * std::sin(phi)), float(1 - h)});
          ray.maximum = infinity;
          if (!object->intersect(ray, hit)) continue;
          expected += std::max(double(dot(ray.direction, normal)), 0.0) * 2 * M_PI * h_end / rays;
        }
        constexpr int side = 72;
        double visible = 0, by_area = 0;
        for (int i = 0; i < side * side; ++i) {
          const Point2 u{(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side};
          const SurfaceSample s = object->sample_visible(from, u, 0);
          if (s.pdf > 0) {
            EXPECT_NEAR(length(s.point.position - (from + s.distance * s.direction)), 0, 1e-3f) << where;
            EXPECT_NEAR(object->visible_pdf(from, s.direction, s.point), s.pdf, 5e-3f * s.pdf) << where;
            const double part = std::max(double(dot(s.direction, normal)), 0.0) / double(s.pdf) *
                                seen(*object, from, s.direction, s.distance) / (side * side);
            visible += part;
          }
          const SurfaceSample a = object->sample_area(u, 0);
          ASSERT_GT(a.pdf, 0);
          EXPECT_NEAR(object->area_pdf(a.point), a.pdf, 1e-3f * a.pdf) << where;
          const Vector3 to = a.point.position - from, direction = normalize(to);
          by_area += std::max(double(dot(direction, normal)), 0.0) * std::abs(double(dot(direction, a.point.normal))) /
                     double(length_squared(to)) / double(a.pdf) * seen(*object, from, direction, length(to)) / (side * side);
        }
        EXPECT_NEAR(visible, expected, 0.012 * expected + 1e-4) << where;
        EXPECT_NEAR(by_area, expected, 0.02 * expected + 2e-4) << where;
        // In finer strata: the part of the surface on which a point lies is chosen within one stratum, and the pdfs of the
        // parts differ.
        constexpr int fine = 400;
        double area = 0;
        for (int i = 0; i < fine * fine; ++i) {
          const Point2 u{(float(i % fine) + 0.5f) / fine, (float(i / fine) + 0.5f) / fine};
          area += 1 / double(object->sample_area(u, 0).pdf) / (fine * fine);
        }
        EXPECT_NEAR(area, double(object->area(0)), 2e-3 * area) << where;
        if (HasFailure()) return;
      }
    }
}

void expect_area(const std::string& shape, const std::string& transform, double expected, double off = 1e-6) {
  const Ref<SceneObject> object = lamp(shape, transform);
  EXPECT_NEAR(double(object->area(0)), expected, (off + double(object->area_error(0))) * expected) << shape << transform;
  EXPECT_LT(object->area_error(0), 1e-6f) << shape << transform;
}

// Areas without a closed form are found by quadrature, to the rounding of floats.
TEST(TransformedLamps, AreasOfClosedForms) {
  // A spheroid, prolate and oblate.
  const double e = std::sqrt(1 - 1 / 9.0);
  expect_area("Sphere { radius: 1", "rotate(33, [1, 1, 0]) * scale(1, 1, 3)", 2 * M_PI * (1 + 3 / e * std::asin(e)));
  expect_area("Sphere { radius: 1", "scale(3, -3, 1)", 2 * M_PI * (9 + std::atanh(e) / e));
  // A disc with the axes (1, 0.5, 0) and (0.3, 1, 0.7): pi times the length of their cross product.
  const double cross = std::sqrt(std::pow(0.5 * 0.7, 2) + std::pow(-0.7, 2) + std::pow(1 - 0.15, 2));
  expect_area("Disc { radius: 1", "matrix(1, 0.3, 0, 0, 0.5, 1, 0, 0, 0, 0.7, 1, 0)", M_PI * cross);
  // A cone stretched along its axis is another cone; so are a cylinder and a box.
  expect_area("Cone { radius: 1, top_radius: 0.4, height: 0.5", "scale(1, 1, 2.4)",
              M_PI * (1 + 0.16 + 1.4 * std::hypot(1.2, 0.6)));
  expect_area("Cone { radius: 1, top_radius: 0.4, height: 0.5", "scale(2)", 4 * M_PI * (1 + 0.16 + 1.4 * std::hypot(0.5, 0.6)));
  expect_area("Cylinder { radius: 1, height: 0.5", "scale(2, 2, 3)", 2 * M_PI * 4 + 4 * M_PI * 1.5);
  expect_area("Box { size: [1, 2, 3]", "scale(3, 2, 1)", 2 * (3 * 4 + 4 * 3 + 3 * 3));
  expect_area("Torus { radius: 1, tube_radius: 0.3", "rotate(20, \"y\") * scale(2)", 4 * M_PI * M_PI * 0.3 * 4);
  expect_area("Annulus { radius: 2, inner_radius: 1, sweep: 90", "scale(1, -3, 1)", M_PI * 3 / 4 * 3);
  expect_area("Rectangle { edge_u: [1, 0, 0], edge_v: [0.5, 1, 0]", "scale(2, 3, 5)", 6);
}

// The area stretch is discontinuous at edges. Under the matrix M a face with the edges a and b has the area |Ma x Mb|, a disc
// with the axes a and b pi |Ma x Mb|; the side of a cone has half the integral over one turn of |(p - apex) x dp|, of which a
// cut-off top takes the square of its fraction of the length.
TEST(TransformedLamps, AreasOfShearedSolids) {
  const double M[3][3] = {{1.3, 0.6, -0.2}, {0.1, 0.7, 0.4}, {-0.3, 0.2, 2.1}};
  const std::string matrix = "matrix(1.3, 0.6, -0.2, 0, 0.1, 0.7, 0.4, 0, -0.3, 0.2, 2.1, 0)";
  using V = std::array<double, 3>;
  const auto moved = [&](const V& v) {
    V r{};
    for (size_t i = 0; i < 3; ++i) r[i] = M[i][0] * v[0] + M[i][1] * v[1] + M[i][2] * v[2];
    return r;
  };
  const auto area = [&](const V& a, const V& b) {
    const V p = moved(a), q = moved(b);
    return std::hypot(p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]);
  };
  const double xy = area({1, 0, 0}, {0, 1, 0}), yz = area({0, 1, 0}, {0, 0, 1}), zx = area({0, 0, 1}, {1, 0, 0});
  expect_area("Box { size: [1, 2, 3]", matrix, 2 * (2 * xy + 6 * yz + 3 * zx));
  expect_area("Box { size: [0.001, 5, 3]", matrix, 2 * (0.005 * xy + 15 * yz + 0.003 * zx));

  // For periodic functions the mean over even steps converges faster than any power.
  const auto around = [](double turn, const auto& f) {
    double sum = 0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) sum += f(turn * (i + 0.5) / steps);
    return sum * turn / steps;
  };
  const auto side = [&](double phi) { return area({-std::sin(phi), std::cos(phi), 0}, {0, 0, 1}); };
  expect_area("Cylinder { radius: 0.5, height: 3", matrix, 2 * M_PI * 0.25 * xy + 0.5 * 3 * around(2 * M_PI, side));
  expect_area("Cylinder { radius: 0.5, height: 3, caps: false, sweep: 130", matrix, 0.5 * 3 * around(130 * M_PI / 180, side));
  expect_area("Tube { radius: 0.5, inner_radius: 0.2, height: 3", matrix,
              2 * M_PI * (0.25 - 0.04) * xy + 0.7 * 3 * around(2 * M_PI, side));
  // A cylinder of axes 2 and 3 across: the perimeter of an ellipse, by its complete elliptic integral.
  expect_area("Cylinder { radius: 1, height: 0.5, caps: false", "scale(2, 3, 7)",
              3.5 * 4 * 3 * std::comp_ellint_2(std::sqrt(1 - 4 / 9.0)));

  const double r0 = 1, r1 = 0.4, h = 0.5, apex = h * r0 / (r0 - r1);
  const double cone =
      0.5 * (1 - r1 * r1 / (r0 * r0)) * around(2 * M_PI, [&](double phi) {
        return area({r0 * std::cos(phi), r0 * std::sin(phi), -apex}, {-r0 * std::sin(phi), r0 * std::cos(phi), 0});
      });
  expect_area("Cone { radius: 1, top_radius: 0.4, height: 0.5", matrix, cone + M_PI * (1 + 0.16) * xy);
  expect_area("Cone { radius: 1, top_radius: 0.4, height: 0.5, caps: false", matrix, cone);
}

// A reflection keeps the front on the side to which it carries the normal.
TEST(TransformedLamps, FrontsOfMirroredLamps) {
  for (const char* shape : {"Disc { radius: 1", "Annulus { radius: 1", "Rectangle { corner: [-0.5, -0.5, 0]",
                            "TriangleMesh { positions: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 2]]"})
    for (const auto& [transform, front] : {std::pair("scale(1)", 1.0f),
                                           {"scale(-1, 1, 1)", 1.0f},
                                           {"scale(1, -2, 1)", 1.0f},
                                           {"scale(1, 1, -1)", -1.0f},
                                           {"scale(-1, -1, -1)", -1.0f},
                                           {"rotate(180, \"x\")", -1.0f}}) {
      const SurfaceSample s = lamp(shape, transform)->sample_area({0.3f, 0.4f}, 0);
      EXPECT_NEAR(s.point.normal.z, front, 1e-6f) << shape << " " << transform;
    }
}

TEST(TransformedLamps, DirectionsFromInfinityTurn) {
  const Ref<SceneObject> distant = prepared_as<SceneObject>(
      "Distant { direction: [1, 0, 0], transform: rotate(90, \"z\") * rotate(30, \"y\"), emission: DiffuseEmission {} }");
  const SurfaceSample s = distant->sample_visible({}, {0.5f, 0.5f}, 0);
  // (1, 0, 0) rotated by 30 degrees about y: (cos, 0, -sin); then by 90 degrees about z: (0, cos, -sin).
  expect_near(-s.direction, {0, float(std::cos(M_PI / 6)), -0.5f});

  const Ref<SceneObject> environment = prepared_as<SceneObject>(
      "Environment { transform: rotate(90, \"z\") * rotate(30, \"y\"), emission: SpotEmission { axis: [1, 0, 0], inner_angle: "
      "5, "
      "outer_angle: 8 } }");
  const Wavelengths w = wavelengths();
  for (const auto& [direction, light] : {std::pair(Vector3{0, float(std::cos(M_PI / 6)), -0.5f}, 1.0f),
                                         {Vector3{1, 0, 0}, 0.0f},
                                         {Vector3{0, float(std::cos(M_PI / 6)), 0.5f}, 0.0f}}) {
    Ray ray;
    ray.direction = -direction;
    SurfacePoint p;
    environment->surface_point(ray, {}, p);
    EXPECT_NEAR(environment->emission->radiance(p, direction, w)[0], light, 1e-5f);
    const float pdf = environment->visible_pdf({}, -direction, p);
    EXPECT_EQ(pdf > 0, light > 0);
  }
  for (int i = 0; i < 20; ++i) {
    const SurfaceSample e = environment->sample_visible({}, {float(i) / 20, 0.7f}, 0);
    EXPECT_GT(dot(-e.direction, Vector3{0, float(std::cos(M_PI / 6)), -0.5f}), std::cos(radians(8.001f)));
    EXPECT_NEAR(environment->visible_pdf({}, e.direction, e.point), e.pdf, 1e-3f * e.pdf);
  }
}

// A ball that grows while it moves is sampled with its shape at each time.
TEST(TransformedLamps, MovingAndGrowing) {
  const Ref<SceneObject> ball = lamp("Sphere { radius: 0.5", "keyframes(0, scale(1), 1, translate(0, 0, 2) * scale(2))");
  for (const double time : {0.0, 0.25, 0.5, 1.0}) {
    const double r = 0.5 * (1 + time), z = 2 * time, d = 6 - z;
    EXPECT_NEAR(double(ball->area(float(time))), 4 * M_PI * r * r, 1e-4);
    const double solid_angle = 2 * M_PI * (1 - std::sqrt(1 - r * r / (d * d)));
    const SurfaceSample s = ball->sample_visible({0, 0, 6}, {0.4f, 0.3f}, float(time));
    EXPECT_NEAR(1 / double(s.pdf), solid_angle, 1e-3 * solid_angle) << time;
    EXPECT_NEAR(double(length(s.point.position - Point3{0, 0, float(z)})), r, 1e-5) << time;
  }
}

// Lamps in stretched, mirrored and nested scenes light a floor like the same shapes written directly in place.
TEST(TransformedLamps, InNestedScenes) {
  const std::string floor =
      "Rectangle { corner: [-9, -9, -1.5], edge_u: [18, 0, 0], edge_v: [0, 18, 0], shader: Lambertian { color: 1 } }\n";
  const std::string camera = "OrthographicCamera { from: [0.3, 0, -1.2], to: [0.3, 0, -1.5], up: [0, 1, 0], width: 0.01 }";
  const std::string outer = "rotate(-20, \"y\") * scale(-1.2, 1, 0.8)",
                    inner = "translate(0.1, 0, 0.1) * rotate(30, [1, 1, 0]) * scale(0.7, 1.1, 0.6)";
  for (const char* shape : {"Sphere { radius: 0.8", "Cone { radius: 0.9, top_radius: 0.3, height: 0.9",
                            "Rectangle { corner: [-0.6, -0.4, 0], edge_u: [1.2, 0.2, 0], edge_v: [0.5, 0.9, 0.3]",
                            "Torus { radius: 0.7, tube_radius: 0.3"}) {
    const std::string emission = ", emission: DiffuseEmission { radiance: 1, sides: both } }";
    const std::string nested = floor + "BruteForceScene { transform: " + outer + ", objects: [ " + shape +
                               ", transform: " + inner + emission + " ] }",
                      flat = floor + shape + ", transform: " + outer + " * " + inner + emission;
    for (const char* renderer :
         {"PathTracer { max_depth: 2, samples: 4096 }", "PathTracer { max_depth: 2, samples: 16384, next_event: false }"}) {
      const Measured a = measure(job_text(renderer, camera, 4, nested)),
                     b = measure(job_text("PathTracer { max_depth: 2, samples: 4096 }", camera, 4, flat));
      EXPECT_NEAR(a.mean.y, b.mean.y, 4.5 * std::hypot(a.error, b.error) + 1e-3 * b.mean.y) << shape << " " << renderer;
      EXPECT_LT(a.error + b.error, 0.012 * b.mean.y) << shape;
    }
  }
}

}  // namespace
}  // namespace etendue::test
