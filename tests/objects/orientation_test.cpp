// Orientations as the manual defines them: the surface coordinates of every object, the middle and the columns of environments,
// right and up in pictures, projected images, the axis of spotlights.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "etendue/film/image_tools.h"
#include "support/image_file.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

struct UvCase {
  const char* object;
  Point3 point;     ///< on the surface
  Vector3 outward;  ///< towards the viewer
  Point2 uv;
};

void PrintTo(const UvCase& c, std::ostream* out) { *out << c.object; }

constexpr float h = 0.70710678f;  // sqrt(1/2)

// The statements of each object's manual page, at points where they can be worked out by hand.
const UvCase uv_cases[] = {
    // u around z from +x towards +y, v from the pole at -z to that at +z.
    {"Sphere { radius: 2 }", {0, 2, 0}, {0, 1, 0}, {0.25f, 0.5f}},
    {"Sphere { radius: 2 }", {-2, 0, 0}, {-1, 0, 0}, {0.5f, 0.5f}},
    {"Sphere { radius: 2 }", {0, -2, 0}, {0, -1, 0}, {0.75f, 0.5f}},
    {"Sphere { radius: 2 }", {0, 2 * h, 2 * h}, {0, h, h}, {0.25f, 0.75f}},
    {"Sphere { radius: 2 }", {0, 2 * h, -2 * h}, {0, h, -h}, {0.25f, 0.25f}},
    {"Ellipsoid { radii: [1, 2, 3] }", {0, 2, 0}, {0, 1, 0}, {0.25f, 0.5f}},
    {"Ellipsoid { radii: [1, 2, 3] }", {0, 2 * h, 3 * h}, {0, h, h}, {0.25f, 0.75f}},
    // u along x and v along y over the square around a disc.
    {"Disc { radius: 2 }", {1, -1, 0}, {0, 0, 1}, {0.75f, 0.25f}},
    {"Annulus { inner_radius: 0.5, radius: 2 }", {1, -1, 0}, {0, 0, 1}, {0.75f, 0.25f}},
    {"Rectangle { corner: [0, 0, 0], edge_u: [4, 0, 0], edge_v: [0, 2, 0] }", {1, 1.5f, 0}, {0, 0, 1}, {0.25f, 0.75f}},
    {"Rectangle {}", {-0.25f, 0.25f, 0}, {0, 0, 1}, {0.25f, 0.75f}},
    // On +x, u is along y and v along z; on +y along z and x; on +z along x and y; u runs backwards on the opposite faces.
    {"Box { size: [4, 4, 4] }", {2, -1, 1}, {1, 0, 0}, {0.25f, 0.75f}},
    {"Box { size: [4, 4, 4] }", {-2, -1, 1}, {-1, 0, 0}, {0.75f, 0.75f}},
    {"Box { size: [4, 4, 4] }", {1, 2, -1}, {0, 1, 0}, {0.25f, 0.75f}},
    {"Box { size: [4, 4, 4] }", {1, -2, -1}, {0, -1, 0}, {0.75f, 0.75f}},
    {"Box { size: [4, 4, 4] }", {-1, 1, 2}, {0, 0, 1}, {0.25f, 0.75f}},
    {"Box { size: [4, 4, 4] }", {-1, 1, -2}, {0, 0, -1}, {0.75f, 0.75f}},
    // u around z from +x towards +y, v upwards; caps like a disc, with u backwards on the one that faces down.
    {"Cylinder { radius: 1, height: 4 }", {0, 1, 1}, {0, 1, 0}, {0.25f, 0.75f}},
    {"Cylinder { radius: 1, height: 4, sweep: 180 }", {0, 1, 1}, {0, 1, 0}, {0.5f, 0.75f}},
    {"Cylinder { radius: 1, height: 4, caps: true }", {0.5f, -0.5f, 2}, {0, 0, 1}, {0.75f, 0.25f}},
    {"Cylinder { radius: 1, height: 4, caps: true }", {0.5f, -0.5f, -2}, {0, 0, -1}, {0.25f, 0.25f}},
    {"Cone { radius: 2, height: 4 }", {0, 1, 2}, {0, 1, 0}, {0.25f, 0.5f}},
    {"Cone { radius: 2, height: 4, caps: true }", {1, -1, 0}, {0, 0, -1}, {0.25f, 0.25f}},
    {"Hyperboloid { waist_radius: 1, radius: 2, height: 4 }", {0, 1, 0}, {0, 1, 0}, {0.25f, 0.5f}},
    {"Paraboloid { radius: 2, height: 4 }", {0, 1, 1}, {0, 1, 0}, {0.25f, 0.5f}},
    {"Tube { inner_radius: 0.5, radius: 1, height: 4 }", {0, 1, 1}, {0, 1, 0}, {0.25f, 0.75f}},
    {"Tube { inner_radius: 0.5, radius: 1, height: 4 }", {0, 0.5f, 1}, {0, -0.2f, 0}, {0.25f, 0.25f}},
    {"Tube { inner_radius: 0.25, radius: 1, height: 4 }", {0.5f, -0.5f, 2}, {0, 0, 1}, {0.75f, 0.25f}},
    // u around the axis from +x towards +y, v around the tube from its outermost circle over +z.
    {"Torus { radius: 2, tube_radius: 0.5 }", {0, 2.5f, 0}, {0, 1, 0}, {0.25f, 0}},
    {"Torus { radius: 2, tube_radius: 0.5 }", {0, 2, 0.5f}, {0, 0, 1}, {0.25f, 0.25f}},
    {"Torus { radius: 2, tube_radius: 0.5 }", {-2, 0, -0.5f}, {0, 0, -1}, {0.5f, 0.75f}},
    {"InfinitePlane {}", {1.5f, -2.5f, 0}, {0, 0, 1}, {1.5f, -2.5f}},
    // u along the first edge, v perpendicular to it to the left, over the polygon's extent.
    {"Polygon { points: [[0, 0, 0], [4, 0, 0], [4, 2, 0], [0, 2, 0]] }", {1, 1.5f, 0}, {0, 0, 1}, {0.25f, 0.75f}},
    {"Triangle { a: [0, 0, 0], b: [4, 0, 0], c: [0, 4, 0] }", {1, 2, 0}, {0, 0, 1}, {0.25f, 0.5f}},
    {"TriangleMesh { positions: [[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles: [[0, 1, 2]] }",
     {1, 2, 0},
     {0, 0, 1},
     {0.25f, 0.5f}},
    {"TriangleMesh { positions: [[0, 0, 0], [4, 0, 0], [0, 4, 0]], triangles: [[0, 1, 2]], uvs: [[1, 1], [0, 1], [1, 0]] }",
     {1, 2, 0},
     {0, 0, 1},
     {0.75f, 0.5f}},
    {"Heightfield { size: [4, 4], heights: [0, 0, 0, 0], nx: 2, ny: 2 }", {-1, 1, 0}, {0, 0, 1}, {0.25f, 0.75f}},
    // Coordinates on the faces of the bounding box, as on a Box.
    {"ImplicitSurface { formula: \"x * x + y * y + z * z - 1\", low: [-2, -2, -2], high: [2, 2, 2] }",
     {0, 0, 1},
     {0, 0, 1},
     {0.5f, 0.5f}},
    {"Quadric { low: [-2, -2, -2], high: [2, 2, 2] }", {0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}, {0.65f, 0.5f}},
    // The surface of a subtracted operand is seen from behind: u runs backwards.
    {"Difference { operands: [ Box { size: [8, 8, 8] }, Box { centre: [0, 0, 4], size: [4, 4, 4] } ] }",
     {-1, 1, 2},
     {0, 0, 1},
     {0.25f, 0.75f}},
};

class UvOf : public testing::TestWithParam<UvCase> {};

TEST_P(UvOf, ObjectsIsWhatTheirPagesSay) {
  const UvCase& c = GetParam();
  const Ref<Job> job =
      load_job_text(job_text("PathTracer {}", "PerspectiveCamera { from: [0, 0, 50], to: [0, 0, 0] }", 4, c.object), "uv.etd");
  prepare_tree(*job->scene);  // the scene alone, so that coordinates stay relative to the origin
  Ray ray;
  ray.origin = c.point + 0.5f * c.outward;
  ray.direction = normalize(-c.outward);
  Hit hit;
  ASSERT_TRUE(job->scene->nearest(ray, hit));
  SurfacePoint p;
  job->scene->locate(ray, hit, p);
  p.object->tangents(p);
  ASSERT_LT(distance(p.position, c.point), 1e-4f);
  EXPECT_NEAR(p.uv.x, c.uv.x, 1e-4f);
  EXPECT_NEAR(p.uv.y, c.uv.y, 1e-4f);
  EXPECT_GT(dot(cross(p.dpdu, p.dpdv), Vector3(p.normal)), 0) << "an image is mirrored";
  EXPECT_GT(dot(Vector3(p.normal), c.outward), 0) << "the front is not outside";
}

INSTANTIATE_TEST_SUITE_P(Points, UvOf, testing::ValuesIn(uv_cases));

// ---- pictures ----------------------------------------------------------------------------------------------------------

/// The position of the brightest pixel.
Point2 brightest(const std::string& camera, const std::string& objects, int size = 9) {
  const Ref<Job> job = load_job_text(job_text("PathTracer { samples: 64, max_depth: 1 }", camera, size, objects), "view.etd");
  const Image image = rendered(job)->film().develop();
  Point2 at{-1, -1};
  double most = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      if (image.at(x, y, 1) > most) most = image.at(x, y, 1), at = {float(x), float(y)};
  return at;
}

TEST(Orientation, RightInAPictureIsTheViewingDirectionTimesUp) {
  const auto lamp = [](const char* where) {
    return fmt::format("Sphere {{ centre: {}, radius: 0.2, emission: DiffuseEmission {{ radiance: 1 }} }}\n", where);
  };
  for (const std::string camera : {"PerspectiveCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], fov: 40 deg }",
                                   "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 3.6 }"}) {
    EXPECT_EQ(brightest(camera, lamp("[1.2, 0, 0]")), (Point2{7, 4})) << camera;  // x is to the right
    EXPECT_EQ(brightest(camera, lamp("[0, 1.2, 0]")), (Point2{4, 1})) << camera;  // y is up: the first row
    EXPECT_EQ(brightest(camera, lamp("[-1.2, -1.2, 0]")), (Point2{1, 7})) << camera;
  }
}

/// An image that is black except for one texel.
std::vector<float> one_texel(int width, int height, int x, int y) {
  std::vector<float> rgb(size_t(3 * width * height));
  for (size_t c = 0; c < 3; ++c) rgb[3 * (size_t(y) * size_t(width) + size_t(x)) + c] = 1;
  return rgb;
}

/// The direction in which a texel of an environment, an 8 x 4 image, is seen: the brightest among the directions of all texel
/// centres.
Vector3 seen_at(int column, int row, const std::string& transform = "") {
  const ImageFile file(fmt::format("orientation-{}-{}.exr", column, row), 8, 4, one_texel(8, 4, column, row));
  Vector3 best;
  double most = 0;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 4; ++j) {
      const double phi = 2 * 3.14159265 * (i + 0.5) / 8, theta = 3.14159265 * (j + 0.5) / 4;
      const Vector3 d{float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)), float(std::sin(theta) * std::sin(phi))};
      const Measured m = measure(job_text(
          "PathTracer { samples: 1, max_depth: 1 }",
          fmt::format("PerspectiveCamera {{ from: [0, 0, 0], to: [{}, {}, {}], up: [0.1, 1, 0.05], fov: 0.01 deg }}", d.x, d.y,
                      d.z),
          1, fmt::format("Environment {{ {} emission: EnvironmentEmission {{ file: \"{}\" }} }}\n", transform, file.path)));
      if (m.mean.y > most) most = m.mean.y, best = d;
    }
  return best;
}

// The image's middle is at +z, its top at +y, its left and right edges at -z; columns run from -z by +x. With 8 columns their
// centres lie half a column, 22.5 degrees, beside these directions.
TEST(Orientation, AnEnvironmentsImage) {
  const float c = std::cos(3.14159265f / 8), s = std::sin(3.14159265f / 8);
  const auto expect = [](const Vector3& seen, const Vector3& level) {
    EXPECT_NEAR(seen.x / std::hypot(seen.x, seen.z), level.x, 1e-3f);
    EXPECT_NEAR(seen.z / std::hypot(seen.x, seen.z), level.z, 1e-3f);
  };
  expect(seen_at(3, 1), {s, 0, c});    // left of the middle: +z, a little to +x
  expect(seen_at(4, 1), {-s, 0, c});   // right of the middle
  expect(seen_at(0, 1), {s, 0, -c});   // the left edge
  expect(seen_at(7, 1), {-s, 0, -c});  // the right edge
  expect(seen_at(1, 1), {c, 0, -s});   // on the way to +x
  expect(seen_at(2, 1), {c, 0, s});    // beyond it
  EXPECT_GT(seen_at(3, 0).y, 0.9f);    // the top row
  EXPECT_LT(seen_at(3, 3).y, -0.9f);
  // Its transform rotates it: by a quarter turn around y, +z goes to +x.
  expect(seen_at(3, 1, "transform: rotate(90, \"y\"),"), {c, 0, -s});
}

// Seen from inside, columns run to the right: the image is not mirrored.
TEST(Orientation, AnEnvironmentIsNotMirrored) {
  const ImageFile left("orientation.exr", 8, 4, one_texel(8, 4, 3, 1));
  const std::string camera = "PerspectiveCamera { from: [0, 0, 0], to: [0, 0.4, 1], up: [0, 1, 0], fov: 90 deg }";
  EXPECT_LT(brightest(camera, "Environment { emission: EnvironmentEmission { file: \"" + left.path + "\" } }\n").x, 4);
}

// For a map around the scene, u is the longitude in the order of an image's columns, and v runs upwards from straight below.
TEST(Orientation, AnEnvironmentsMap) {
  const auto seen = [](const std::string& formula, const Vector3& d) {
    const std::string camera = fmt::format(
        "PerspectiveCamera {{ from: [0, 0, 0], to: [{}, {}, {}], up: [0.1, 1, 0.05], fov: 0.01 deg }}", d.x, d.y, d.z);
    return measure(job_text("PathTracer { samples: 1, max_depth: 1 }", camera, 1,
                            "Environment { emission: EnvironmentEmission { radiance: FormulaMap { formula: \"" + formula +
                                "\" } } }\n"))
        .mean.y;
  };
  const auto expect = [&](const Vector3& d, Point2 uv) {
    EXPECT_NEAR(seen("u", d) / seen("1", d), uv.x, 1e-3) << d.x << " " << d.y << " " << d.z;
    EXPECT_NEAR(seen("v", d) / seen("1", d), uv.y, 1e-3) << d.x << " " << d.y << " " << d.z;
  };
  expect({0, 0, 1}, {0.5f, 0.5f});
  expect({1, 0, 0}, {0.25f, 0.5f});
  expect({-1, 0, 0}, {0.75f, 0.5f});
  expect({1, 1, 0}, {0.25f, 0.75f});                                     // 45 degrees up
  expect({0, -std::sqrt(3.0f), 1}, {0.5f, 1 / 6.0f});                    // 60 degrees down
  expect({h, std::sqrt(1 / 3.0f), h}, {3 / 8.0f, 1 / 2.0f + 1 / 6.0f});  // 30 degrees up, between +x and +z
}

// The image's top towards +y and its right towards -x, as seen from behind.
TEST(Orientation, AProjectedImage) {
  const auto lit = [](int x, int y) {
    const ImageFile file(fmt::format("projected-{}-{}.exr", x, y), 2, 2, one_texel(2, 2, x, y));
    // Seen from behind the projector: -x is to the right.
    const Ref<Job> job = load_job_text(
        job_text("DirectRenderer { samples: 16 }",
                 "OrthographicCamera { from: [0, 0, -1], to: [0, 0, 1], up: [0, 1, 0], width: 2 }", 2,
                 "Rectangle { corner: [-2, -2, 1], edge_u: [4, 0, 0], edge_v: [0, 4, 0], shader: Lambertian {} }\n"
                 "Point { emission: ProjectorEmission { file: \"" +
                     file.path + "\", fov: 90 } }\n"),
        "projector.etd");
    const Image image = rendered(job)->film().develop();
    Point2 at{-1, -1};
    double most = 0;
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i)
        if (image.at(i, j, 1) > most) most = image.at(i, j, 1), at = {float(i), float(j)};
    return at;
  };
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) EXPECT_EQ(lit(x, y), (Point2{float(x), float(y)}));
}

// The axis is the direction in which the light travels, in object space.
TEST(Orientation, TheAxisOfASpotlight) {
  const auto lit = [](const std::string& lamp, const std::string& camera) {
    return measure(
               job_text("DirectRenderer { samples: 4 }", camera, 1, "Sphere { radius: 10, shader: Lambertian {} }\n" + lamp))
               .mean.y > 0;
  };
  const auto towards = [](const char* to) {
    return fmt::format("PerspectiveCamera {{ from: [0, 0, 0], to: {}, up: [0.1, 0.2, 1], fov: 1 deg }}", to);
  };
  const std::string along_x = "Point { emission: SpotEmission { axis: [1, 0, 0], inner_angle: 10, outer_angle: 20 } }\n";
  EXPECT_TRUE(lit(along_x, towards("[1, 0, 0]")));
  EXPECT_FALSE(lit(along_x, towards("[-1, 0, 0]")));
  EXPECT_FALSE(lit(along_x, towards("[0, 1, 0]")));
  const std::string turned =
      "Point { transform: rotate(90, \"z\"), emission: SpotEmission { axis: [1, 0, 0], inner_angle: 10, outer_angle: 20 } }\n";
  EXPECT_TRUE(lit(turned, towards("[0, 1, 0]")));
  EXPECT_FALSE(lit(turned, towards("[1, 0, 0]")));
}

}  // namespace
}  // namespace etendue::test
