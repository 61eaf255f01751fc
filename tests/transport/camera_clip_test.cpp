// Near and far planes of cameras: no algorithm shows objects beyond them, but these objects still cast shadows.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/component_test_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using test::create;

// A diffuse plate at z = 0 under a point light of intensity I at (1.25, 0, 4.5), seen from z = 5 in four columns of half a
// metre. A black strip at z = 3, from x = 1/2 to 2/3, covers a third of the last column, and its shadow, three times as large,
// is the first column. At z = 1 is a null-scattering pane. The irradiance of the plate is I h / (r^2 + h^2)^(3/2).
Image picture(const std::string& renderer, const std::string& camera, int samples) {
  const Ref<Job> job = load_job_text(
      fmt::format(
          "Job {{ renderer: {}, camera: {}, image: ImageBuffer {{ width: 4, height: 2, filter: BoxFilter {{}} }}, scene: "
          "EmbreeScene {{ objects: ["
          "Rectangle {{ corner: [-4, -4, 0], edge_u: [8, 0, 0], edge_v: [0, 8, 0], shader: Lambertian {{ color: 1 }} }}, "
          "Rectangle {{ corner: [0.5, -4, 3], edge_u: [{}, 0, 0], edge_v: [0, 8, 0] }}, "
          "Rectangle {{ corner: [-4, -4, 1], edge_u: [8, 0, 0], edge_v: [0, 8, 0], shader: PassThrough {{}} }}, "
          "Point {{ position: [1.25, 0, 4.5], emission: DiffuseEmission {{ radiance: 1 }} }} ] }} }}",
          renderer, camera, 1.0 / 6),
      "clip.etd");
  job->renderer->samples = samples;
  return test::rendered(job)->picture();
}

/// The irradiance of a column, in relative units; `hidden`: without the part that the strip covers.
double irradiance(int column, bool hidden) {
  constexpr int n = 120;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = -1 + 0.5 * (column + (i + 0.5) / n), y = -0.5 + (j + 0.5) / n, h = 4.5;
      if (hidden && x > 0.5 && x < 2.0 / 3) continue;
      if (x < -0.5) continue;  // in the shadow
      sum += h / std::pow(std::pow(x - 1.25, 2) + y * y + h * h, 1.5) / (n * n);
    }
  return sum;
}

const std::vector<std::string> algorithms{"PathTracer {}", "LightTracer {}", "BidirectionalPathTracer {}",
                                          "VertexConnectionMerging {}", "DirectRenderer {}"};

std::string parallel(const std::string& clip) {
  return "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 2" + clip + " }";
}

TEST(CameraClip, LeavesOutWhatIsSeenAndNotItsShadow) {
  const double unit = picture("PathTracer {}", parallel(""), 4096).at(1, 0, 1) / irradiance(1, true);
  for (const std::string& renderer : algorithms)
    for (const bool clipped : {false, true}) {
      const int samples = renderer.starts_with("Light") ? 1 << 17 : 4096;
      const Image seen = picture(renderer, parallel(clipped ? ", near_clip: 2.5, far_clip: 5.1" : ""), samples);
      for (int x = 0; x < 4; ++x) {
        const double expected = unit * irradiance(x, !clipped);
        const double found = (seen.at(x, 0, 1) + seen.at(x, 1, 1)) / 2;
        EXPECT_NEAR(found, expected, 0.04 * unit * irradiance(1, true)) << renderer << " at " << x << ", clipped: " << clipped;
      }
    }
}

TEST(CameraClip, NothingIsSeenBeyondThePlanes) {
  for (const std::string& renderer : algorithms)
    for (const char* clip : {", far_clip: 4.9", ", near_clip: 5.1"}) {
      const Image seen = picture(renderer, parallel(clip), 64);
      for (int x = 0; x < 4; ++x) EXPECT_EQ(seen.at(x, 0, 1), 0) << renderer << clip;
    }
}

TEST(CameraClip, AlgorithmsAgreeThroughLenses) {
  const std::string camera =
      "PerspectiveCamera { from: [0.3, 0, 5], to: [0, 0.1, 0], up: [0, 1, 0], fov: 20, lens_radius: 0.2, near_clip: 1.7, "
      "far_clip: 4.97 }";  // the strip is seen, and a part of the plate
  const Image by_rays = picture("PathTracer {}", camera, 1 << 14);
  double brightest = 0;
  for (int x = 0; x < 4; ++x) brightest = std::max(brightest, double(by_rays.at(x, 0, 1)));
  ASSERT_GT(brightest, 0);
  for (const std::string& renderer : algorithms) {
    const Image seen = picture(renderer, camera, renderer.starts_with("Light") ? 1 << 18 : 1 << 13);
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 4; ++x)
        EXPECT_NEAR(seen.at(x, y, 1), by_rays.at(x, y, 1), 0.04 * brightest) << renderer << " at " << x << ", " << y;
  }
}

// The planes are perpendicular to the axis, as in Mitsuba: depth is measured along the axis.
TEST(CameraClip, RaysBeginAndEndInPlanesAcrossTheAxis) {
  const std::vector<double> from{1, 2, -3}, to{0.5, 1, 4};
  const Vector3 axis = normalize(Vector3{-0.5f, -1, 7});
  for (const bool lens : {false, true}) {
    const Ref<Camera> camera = create<Camera>(
        "PerspectiveCamera",
        {{"from", from}, {"to", to}, {"fov", 70.0}, {"lens_radius", lens ? 0.2 : 0.0}, {"near_clip", 0.75}, {"far_clip", 9.0}});
    camera->set_film(320, 200);
    test::Random random(3);
    for (int i = 0; i < 50; ++i) {
      const Point2 u = random.pair();
      const Ray ray = camera->ray({u.x * 320, u.y * 200}, random.pair(), 0);
      const auto depth = [&](const Point3& p) { return dot(axis, p - Point3{1, 2, -3}); };
      EXPECT_NEAR(depth(ray.origin), 0.75, 1e-5f);
      EXPECT_NEAR(depth(ray(ray.maximum)), 9, 1e-4f);
      EXPECT_NEAR(depth(camera->lens_point(ray)), 0, 1e-5f);
      EXPECT_NEAR(distance(camera->lens_point(ray), Point3{1, 2, -3}), 0, lens ? 0.2001f : 1e-5f);
      EXPECT_TRUE(camera->film_point(ray));
      EXPECT_FALSE(camera->sample_lens(ray(-0.01f), 0, {0.5f, 0.5f}));
      EXPECT_FALSE(camera->sample_lens(ray(ray.maximum + 0.01f), 0, {0.5f, 0.5f}));
      const auto seen = camera->sample_lens(ray(2), 0, {0.5f, 0.5f});
      if (seen) EXPECT_NEAR(depth(seen->lens - seen->nearest * seen->direction), 0.75, 1e-4f);
    }
  }
}

TEST(CameraClip, PlanesWithNothingBetweenAreRefused) {
  for (const char* camera : {"PerspectiveCamera", "OrthographicCamera"}) {
    EXPECT_THROW(create<Camera>(camera, {{"near_clip", 2.0}, {"far_clip", 1.0}}), Error);
    EXPECT_THROW(create<Camera>(camera, {{"near_clip", -1.0}}), Error);
    EXPECT_NO_THROW(create<Camera>(camera, {{"near_clip", 2.0}}));
  }
}

}  // namespace
}  // namespace etendue
