// SphericalCamera: solid angles of its pixels, and its pictures used as environments.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "etendue/camera.h"
#include "support/component_test_support.h"
#include "support/image_file.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using test::create;
using List = std::vector<double>;

const char* const mappings[] = {"equirectangular", "equal_area"};

Ref<Camera> camera_of(const char* mapping, int width, int height) {
  const Ref<Camera> camera = create<Camera>(
      "SphericalCamera",
      {{"from", List{1, 2, -3}}, {"to", List{0.5, 1, 4}}, {"up", List{0.1, 1, 0}}, {"mapping", std::string(mapping)}});
  camera->set_film(width, height);
  return camera;
}

TEST(SphericalCamera, FilmPointsComeBackAndDensitiesAreThoseOfPixels) {
  test::Random random(1);
  for (const char* mapping : mappings) {
    constexpr int width = 64, height = 48;
    const Ref<Camera> camera = camera_of(mapping, width, height);
    for (int i = 0; i < 2000; ++i) {
      const Point2 u = random.pair(), film{width * u.x, height * u.y};
      const Ray ray = camera->ray(film, {}, 0);
      const auto back = camera->film_point(ray);
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->x, film.x, 2e-3f) << mapping << " " << film.x << " " << film.y;
      EXPECT_NEAR(back->y, film.y, 2e-3f) << mapping << " " << film.x << " " << film.y;
      // The solid angle of a small square of film is the cross product of its edges. Squares across the folds of the equal-area
      // square are left out, because the direction is not differentiable there.
      constexpr float step = 0.02f;
      const float a = std::abs(2 * u.x - 1), b = std::abs(2 * u.y - 1);
      if (std::min({a, b, std::abs(a + b - 1)}) < 0.02f || u.y < 0.02f || u.y > 0.98f) continue;
      const Vector3 across = camera->ray({film.x + step, film.y}, {}, 0).direction - ray.direction,
                    down = camera->ray({film.x, film.y + step}, {}, 0).direction - ray.direction;
      const double omega = double(length(cross(across, down))) / (step * step) * width * height;  // scaled to the whole film
      EXPECT_NEAR(double(camera->pdf(ray).direction) * omega, 1, 0.02) << mapping << " " << film.x << " " << film.y;
      EXPECT_EQ(camera->importance(ray), camera->pdf(ray).direction);
      // The ray's cone covers the pixel's solid angle.
      EXPECT_NEAR(ray.spread * ray.spread / (omega / (width * height)), 1, 0.02);
    }
  }
}

// +z is in the middle, +y at the top, and -x, the cross product of viewing direction and up, on the right.
TEST(SphericalCamera, WhereDirectionsLie) {
  for (const char* mapping : mappings) {
    const Ref<Camera> camera = create<Camera>("SphericalCamera", {{"mapping", std::string(mapping)}});
    camera->set_film(100, 100);
    const bool square = mapping == std::string("equal_area");
    const struct {
      Vector3 towards;
      float x, y;
    } rows[] = {{{0, 0, 1}, 50, 50},
                {{-1, 0, 0}, square ? 100.0f : 75.0f, 50},
                {{1, 0, 0}, square ? 0.0f : 25.0f, 50},
                {{0, 1, 1e-4f}, 50, 0},
                {{0, -1, 1e-4f}, 50, 100}};
    for (const auto& row : rows) {
      Ray ray;
      ray.direction = normalize(row.towards);
      const auto film = camera->film_point(ray);
      ASSERT_TRUE(film);
      EXPECT_NEAR(film->x, row.x, 0.01f) << mapping;
      EXPECT_NEAR(film->y, row.y, 0.01f) << mapping;
    }
  }
}

// The picture of an environment equals the environment's image.
TEST(SphericalCamera, SeesAnEnvironmentAsItsImage) {
  const TemporaryFolder folder;
  for (const char* mapping : mappings) {
    const bool square = mapping == std::string("equal_area");
    constexpr int height = 32;
    const int width = square ? height : 2 * height;
    std::vector<float> rgb;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)  // equal at both ends of an edge that is shared
        for (const float c :
             {0.6f + 0.3f * std::sin(2 * pi * float(x) / float(width)), 0.5f + 0.4f * std::cos(pi * float(y) / height), 0.25f})
          rgb.push_back(c);
    const std::string file = folder / "sky.exr";
    test::write_image(file, {width, height, 3, NumberType::single}, rgb);
    const Ref<Job> job = load_job_text(
        fmt::format(
            "Job {{ renderer: PathTracer {{ samples: 1024 }}, camera: SphericalCamera {{ mapping: {}, to: {}, up: {} }}, "
            "image: ImageBuffer {{ width: {}, height: {}, filter: BoxFilter {{}} }}, scene: BruteForceScene {{ objects: [ "
            "Environment {{ emission: EnvironmentEmission {{ file: \"{}\", layout: {} }} }} ] }} }}",
            mapping, square ? "[0, 1, 0]" : "[0, 0, 1]", square ? "[0, 0, 1]" : "[0, 1, 0]", width, height, file,
            square ? "equal_area" : "lat_long"),
        "sky.etd");
    const Image seen = test::rendered(job)->picture();
    // The image is not continuous where the square's edges meet.
    const int edge = square ? 2 : 0;
    for (int y = edge; y < height - edge; ++y)
      for (int x = edge; x < width - edge; ++x) {
        const float* c = &rgb[size_t(3 * (y * width + x))];
        EXPECT_NEAR(seen.at(x, y, 1), 0.212671 * double(c[0]) + 0.71516 * double(c[1]) + 0.072169 * double(c[2]), 0.025)
            << mapping << " " << x << " " << y;
      }
  }
}

// A luminous ball above the camera, seen under the half angle a. In the picture of longitude and latitude it fills the rows
// down to a, a / pi of all; in the equal-area picture its fraction of the sphere, (1 - cos a) / 2. Both by paths from the
// camera and by light paths that reach it.
TEST(SphericalCamera, ShowsABallAsLargeAsItIsByAllAlgorithms) {
  const double half = std::asin(0.5);
  for (const char* mapping : mappings)
    for (const char* renderer : {"PathTracer", "LightTracer", "BidirectionalPathTracer"}) {
      const Ref<Job> job = load_job_text(
          fmt::format(
              "Job {{ renderer: {} {{ samples: 4096 }}, camera: SphericalCamera {{ mapping: {}, from: [1, 2, 3], to: [4, 2, "
              "5] }}, image: ImageBuffer {{ width: 8, height: 8, filter: BoxFilter {{}} }}, scene: BruteForceScene {{ "
              "objects: [ Sphere {{ centre: [1, 4, 3], radius: 1, shader: Lambertian {{ color: 0 }}, emission: "
              "DiffuseEmission {{ radiance: 1 }} }} ] }} }}",
              renderer, mapping),
          "ball.etd");
      const double expected = mapping == std::string("equal_area") ? (1 - std::cos(half)) / 2 : half / M_PI;
      const test::Measured m = test::measure(job);
      EXPECT_NEAR(m.mean.y, expected, 0.012 * expected) << mapping << " " << renderer;
    }
}

}  // namespace
}  // namespace etendue
