// Environments are sampled where they are seen: the probabilities of tiles, their regions, a closed form indoors, the same bits
// for any threads.

#include "etendue/render/adaptive_lights.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/render_support.h"

namespace etendue {
namespace {

TEST(EnvironmentGuide, SamplesHaveTheProbabilitiesOfTheirTiles) {
  EnvironmentGuide guide;
  guide.divide({}, 16, 4);
  ASSERT_EQ(guide.regions(), 1u);
  EnvironmentGuide::Squares squares{};
  squares[5 * EnvironmentGuide::side + 3] = 4;
  squares[5 * EnvironmentGuide::side + 4] = 1;
  guide.learn(0, squares);
  const auto ratio_at = [&](int column, int row) {
    return guide.ratio(0, {(float(column) + 0.5f) / EnvironmentGuide::side, (float(row) + 0.5f) / EnvironmentGuide::side});
  };
  // The roots of the squares are as 2 to 1, in one row; in each dimension an entry has one part of 256, and its share of the
  // other 240. A part of one dimension times one of the other is 1 / 256 of equal tiles. An eighth of the samples is even.
  EXPECT_NEAR(ratio_at(3, 5), 0.125 + 0.875 * 241 * 161 / 256, 1e-3);
  EXPECT_NEAR(ratio_at(4, 5), 0.125 + 0.875 * 241 * 81 / 256, 1e-3);
  EXPECT_NEAR(ratio_at(15, 15), 0.125 + 0.875 * 1 * 16 / 256, 1e-4);

  // Midpoints of a fine grid of numbers: the mean of 1 / ratio over samples is the area of the unit square, and as many samples
  // fall into a tile as its probability says.
  constexpr int fine = 512;
  double area = 0, bright = 0;
  for (int i = 0; i < fine; ++i)
    for (int j = 0; j < fine; ++j) {
      const EnvironmentGuide::Guided s = guide.sample(0, {(float(i) + 0.5f) / fine, (float(j) + 0.5f) / fine});
      ASSERT_FLOAT_EQ(s.ratio, guide.ratio(0, s.place));
      area += 1 / double(s.ratio) / (fine * fine);
      bright += s.place.y >= 5 / 16.0f && s.place.y < 6 / 16.0f && s.place.x >= 3 / 16.0f && s.place.x < 4 / 16.0f;
    }
  EXPECT_NEAR(area, 1, 0.01);
  EXPECT_NEAR(bright / (fine * fine), double(ratio_at(3, 5)) / 256, 0.005);
}

TEST(EnvironmentGuide, RegionsDivideByPositionAndNormal) {
  std::vector<EnvironmentGuide::Place> places;
  for (int i = 0; i < 64; ++i)
    places.push_back({{i % 2 ? 5.0f : -5.0f, float(i) / 100, 0}, i % 4 < 2 ? Normal3{0, 0, 1} : Normal3{0, 0, -1}});
  EnvironmentGuide guide;
  guide.divide(places, 16, 10);
  ASSERT_EQ(guide.regions(), 4u);
  for (size_t i = 4; i < places.size(); ++i)
    EXPECT_EQ(guide.region(places[i].position, places[i].normal), guide.region(places[i % 4].position, places[i % 4].normal));
  for (size_t i = 0; i < 4; ++i)
    for (size_t k = 0; k < i; ++k)
      EXPECT_NE(guide.region(places[i].position, places[i].normal), guide.region(places[k].position, places[k].normal));
}

/// A black room, a cylinder of radius 2, whose lid at the height 1 has a hole of radius 0.2 to a sky of radiance 1. The camera
/// sees the middle of the floor, of reflectance 1/2.
std::string room(const std::string& renderer) {
  return test::job_text(renderer, "PerspectiveCamera { from: [0, 0, 0.5] m, to: [0, 0, 0] m, up: [0, 1, 0], fov: 2 deg }", 32,
                        "Disc { radius: 2 m, shader: Lambertian { color: 0.5 } },"
                        "Cylinder { radius: 2 m, height: 2 m, caps: false, shader: Lambertian { color: 0 } },"
                        "Annulus { inner_radius: 0.2 m, radius: 2 m, shader: Lambertian { color: 0 }, "
                        "transform: translate(0, 0, 1) },"
                        "Environment { emission: EnvironmentEmission { radiance: 1 } }");
}

TEST(AdaptiveLights, LightThroughAHoleHasItsClosedFormAndLittleNoise) {
  // The view factor of a disc of radius r at the height h: r^2 / (h^2 + r^2).
  const double factor = 0.5 * 0.04 / 1.04;
  // The mean Y of a flat spectrum of radiance 1 is 1 (the equal-energy white).
  const test::Measured adaptive = test::measure(room("PathTracer { samples: 16 }")),
                       plain = test::measure(room("SimplePathTracer { samples: 16 }"));
  EXPECT_NEAR(adaptive.mean.y, factor, 5 * adaptive.error + 1e-3 * factor);
  EXPECT_NEAR(plain.mean.y, factor, 5 * plain.error + 1e-3 * factor);
  // Of the sphere of directions the hole is a hundredth: with all samples alike the variance is some hundred times the square
  // of the mean, where they go to the hole's tiles it is a few times that.
  EXPECT_LT(adaptive.error, 0.45 * plain.error);
}

TEST(AdaptiveLights, OfTwoLampsThatWhichIsSeenIsAsked) {
  // Two lamps alike, at the same distance from the middle of a floor; a wall hides one of them.
  const auto lamps = [](const std::string& renderer) {
    const std::string lamp = ", 0, 0.5] m, radius: 0.05 m, emission: DiffuseEmission { radiance: 1 } },";
    return test::job_text(renderer, "PerspectiveCamera { from: [0, 0, 0.5] m, to: [0, 0, 0] m, up: [0, 1, 0], fov: 2 deg }", 32,
                          "Disc { radius: 2 m, shader: Lambertian { color: 0.5 } }, Sphere { centre: [0.5" + lamp +
                              "Sphere { centre: [-0.5" + lamp +
                              "Box { centre: [-0.25, 0, 1] m, size: [0.1, 2, 2] m, shader: Lambertian { color: 0 } }");
  };
  const test::Measured adaptive = test::measure(lamps("PathTracer { samples: 16, max_depth: 2 }")),
                       plain = test::measure(lamps("SimplePathTracer { samples: 16, max_depth: 2 }"));
  EXPECT_NEAR(adaptive.mean.y, plain.mean.y, 5 * std::hypot(adaptive.error, plain.error));
  EXPECT_GT(plain.mean.y, 10 * plain.error);
  // A lamp chosen with the probability P adds 1 / P - 1 to the relative variance: 1 where both are alike, 0.15 and little more
  // where the one that is seen is chosen seven times out of eight.
  EXPECT_LT(adaptive.error, 0.6 * plain.error);
}

// A patch of sunlight 40 cm wide in a room of 4 m, which few or none of the paths meet that learn: where nothing of the sun was
// seen, its samples must not become so rare that each is a firefly.
TEST(AdaptiveLights, SunInASmallPatchIsNotLost) {
  const auto room = [](const std::string& renderer) {
    return test::job_text(renderer, "PerspectiveCamera { from: [0, -1.7, 0.5] m, to: [0, 0, 0] m, up: [0, 0, 1], fov: 60 deg }",
                          64,
                          "Disc { radius: 2 m, shader: Lambertian { color: 0.5 } },"
                          "Cylinder { radius: 2 m, height: 2 m, caps: false, shader: Lambertian { color: 0.5 } },"
                          "Annulus { inner_radius: 0.2 m, radius: 2 m, shader: Lambertian { color: 0.5 }, "
                          "transform: translate(0, 0, 1) },"
                          "Environment { transform: rotate(90 deg, \"x\"), emission: SkyEmission { "
                          "sun_direction: [0.2, 0.9, 0.1], turbidity: 3, sun: true } }");
  };
  const test::Measured adaptive = test::measure(room("PathTracer { samples: 64, max_depth: 4 }")),
                       plain = test::measure(room("SimplePathTracer { samples: 64, max_depth: 4 }"));
  EXPECT_NEAR(adaptive.mean.y, plain.mean.y, 5 * std::hypot(adaptive.error, plain.error));
  EXPECT_LT(adaptive.error, 2.5 * plain.error);
}

// Squares of what such lamps give are beyond the range of numbers.
TEST(AdaptiveLights, NothingIsTooBright) {
  const auto lamps = [](const std::string& radiance) {
    const std::string lamp = "] m, radius: 0.05 m, emission: DiffuseEmission { radiance: " + radiance + " } }";
    return test::job_text("PathTracer { samples: 4, max_depth: 2 }",
                          "PerspectiveCamera { from: [0, 0, 0.5] m, to: [0, 0, 0] m, up: [0, 1, 0], fov: 2 deg }", 16,
                          "Disc { radius: 2 m, shader: Lambertian { color: 0.5 } }, Sphere { centre: [0.5, 0, 0.5" + lamp +
                              ", Sphere { centre: [-0.5, 0, 0.5" + lamp + ", Sphere { centre: [0, 0.5, 0.5" + lamp);
  };
  const test::Measured bright = test::measure(lamps("1e25")), usual = test::measure(lamps("1"));
  EXPECT_EQ(bright.bad, 0u);
  EXPECT_GT(usual.mean.y, 10 * usual.error);
  EXPECT_NEAR(bright.mean.y / 1e25, usual.mean.y, 5 * std::hypot(bright.error / 1e25, usual.error));
}

/// Shows whether the lamp is sampled at the first surface of a camera path: 1, or 0; and checks the pdf.
class AskedLamps final : public Renderer {
 public:
  static void describe(Description<AskedLamps>& d) { d.summary("For tests: whether a lamp is sampled."); }
  Expectation expectation() const override { return Expectation::biased; }
  PathClasses finds() const override { return no_paths; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext& context) const override {
    return adaptive_process(
        *this, context, [&scene = context.scene](const LightSampler& lights, const Ray& ray, SampleContext& sample) {
          Hit hit;
          SurfacePoint p;
          if (!scene.nearest(ray, hit)) return Spectrum();
          scene.locate(ray, hit, p);
          const LightChoice lamp = lights.choose(p.position, p.normal, sample.numbers.next());
          const SurfaceSample s = lights.sample(*lamp.luminaire, p.position, p.normal, sample.numbers.next_pair(), 0);
          if (!(s.pdf > 0)) return Spectrum();
          EXPECT_NEAR(lights.pdf(*lamp.luminaire, p.position, p.normal, s.direction, s.point), s.pdf, 1e-3f * s.pdf);
          return Spectrum(1.0f);
        });
  }
};

// A wall in the middle of a room hides a lamp on one side of it from the other.
TEST(AdaptiveLights, WhereNoLightIsSeenAFourthOfTheSamplesIsTaken) {
  static const Register<AskedLamps> registered;  // only once this test runs: other tests go through all renderers
  const auto share = [](const std::string& x, const std::string& more) {
    const std::string camera =
        "PerspectiveCamera { from: [" + x + ", 0, 0.5] m, to: [" + x + ", 0, 0] m, up: [0, 1, 0], fov: 80 deg }";
    return test::measure(
        test::job_text("AskedLamps { samples: 64 }", camera, 32,
                       "Disc { radius: 2 m, shader: Lambertian { color: 0.5 } }, Box { centre: [0, 0, 1] m, "
                       "size: [0.1, 4, 2] m, shader: Lambertian { color: 0 } }, Sphere { centre: [1, 0, 0.8] m, "
                       "radius: 0.05 m, emission: DiffuseEmission { radiance: 1 } }" +
                           more));
  };
  const test::Measured dark = share("-1", ""), lit = share("1", "");
  EXPECT_NEAR(dark.mean.y, 0.25, 5 * dark.error + 1e-4);
  EXPECT_NEAR(lit.mean.y, 1, 1e-4);
  // A sky that is seen from both sides.
  EXPECT_NEAR(share("-1", ", Environment { emission: EnvironmentEmission { radiance: 1 } }").mean.y, 1, 1e-4);
}

TEST(AdaptiveLights, TheSameBitsForAnyThreads) {
  const auto picture = [](int threads) {
    const Ref<Job> job = load_job_text(room("PathTracer { samples: 2 }"), "test.etd");
    return test::rendered(job, {.threads = threads})->picture();
  };
  EXPECT_EQ(picture(1).values, picture(3).values);
}

}  // namespace
}  // namespace etendue
