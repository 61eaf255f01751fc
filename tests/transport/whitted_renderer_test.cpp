// WhittedRenderer.
// Statistical tests use fixed seeds and hold at 4.5 standard errors (two-sided 7e-6 each), unless they say otherwise.

#include <gtest/gtest.h>

#include "support/simple_renderers_support.h"

namespace etendue::test {
namespace {

TEST(WhittedRenderer, PlaneUnderLightsWithoutExtent) {
  const std::string camera = pinhole("[0,0,1]", "[0,0,0]");
  const auto value = [&](const std::string& objects) {
    return Ready(job_text(whitted(2), camera, 1, floor_of("Lambertian { color: 0.5 }") + objects)).sample(0, 0, 0).value;
  };
  expect_flat(value(distant(0, 0, -1)), 0.159155f);
  expect_flat(value(distant(1, 0, -1)), 0.159155f * std::sqrt(0.5f));
  // Two distant lights and a point light, each in full: none is sampled. E = I cos / d^2 = 6 (1/2^0.5) / 8.
  const std::string all =
      distant(0, 0, -1) + "\n" + distant(1, 0, -1) + "\nPoint { position: [2,0,2], emission: DiffuseEmission { radiance: 6 } }";
  const float root = std::sqrt(0.5f);
  expect_flat(value(all), 0.159155f * (1 + root + 6 * root / 8));
  // Zero in the shadow of an object, and under an area light.
  expect_flat(value(distant(1, 0, -1) + "\nSphere { centre: [-1,0,1], radius: 0.1 }"), 0);
  expect_flat(value("Sphere { centre: [0,3,3], radius: 1, emission: " + lit + " }"), 0);
}

TEST(WhittedRenderer, LambertSphereFromAfar) {  // the mean over its disc is (2/3) [sin a + (pi - a) cos a] / pi^2
  for (const double degrees : {0.0, 45.0, 90.0, 135.0}) {
    const double a = degrees * double(pi) / 180;
    const Measured m =
        measure(job_text(whitted(2, 64), "OrthographicCamera { from: [0,0,5], to: [0,0,0], up: [0,1,0], width: 2 }", 64,
                         "Sphere { radius: 1, " + diffuse + " }\n" + distant(std::sin(a), 0, -std::cos(a))));
    const double mean = 2.0 / 3 * (std::sin(a) + (double(pi) - a) * std::cos(a)) / double(pi * pi);
    EXPECT_EQ(m.bad, 0u);
    EXPECT_NEAR(m.mean.y, mean * double(pi) / 4, 0.003 * mean) << degrees;
  }
}

// The lower lamp by paths of n segments gives (1-R)^2 R^(n-3) for n = 3, 5, …; the upper one R for n = 2 and (1-R)^2 R^(n-3)
// for n = 4, 6, ….
TEST(WhittedRenderer, TreeOfAGlassSlab) {
  const std::string objects = slab + "Rectangle { corner: [-9,-9,-3], edge_u: [18,0,0], edge_v: [0,18,0], emission: " + lit +
                              " }\nRectangle { corner: [-9,-9,5], edge_u: [18,0,0], edge_v: [0,18,0], emission: "
                              "DiffuseEmission { radiance: 10, sides: both } }";
  Ready ready(job_text(whitted(7), pinhole("[0,0,3]", "[0,0,0]"), 1, objects));
  std::array<Spectrum, 10> lengths{};
  const auto s = ready.sample(0, 0, 0, lengths);
  const double r = 0.04, t = (1 - r) * (1 - r);
  const double expected[10] = {0, 10 * r, t, 10 * t * r, t * r * r, 10 * t * r * r * r, t * r * r * r * r, 0, 0, 0};
  double sum = 0;
  for (size_t n = 0; n < lengths.size(); ++n) {
    expect_flat(lengths[n], float(expected[n]), 2e-4f);
    sum += expected[n];
  }
  expect_flat(s.value, float(sum));
}

TEST(WhittedRenderer, MirrorsShowLitSurfaces) {
  // Up to a mirror, down to the floor: 0.7 * 0.8 / pi * E.
  const std::string objects = floor_of("Lambertian { color: 0.8 }") +
                              "Rectangle { corner: [-1,-1,2], edge_u: [2,0,0], edge_v: [0,2,0], shader: PerfectSpecular { "
                              "color: 0.7 } }\n" +
                              distant(0, 1, -1, 5);
  // The camera looks up at 45 degrees; the ray comes down to (2, 0, 0), where the mirror casts no shadow.
  Ready ready(job_text(whitted(3), pinhole("[-1,0,1]", "[0,0,2]"), 1, objects));
  std::array<Spectrum, 4> lengths{};
  expect_flat(ready.sample(0, 0, 0, lengths).value, 0.7f * 0.8f * inverse_pi * 5 * std::sqrt(0.5f), 1e-4f);
  expect_flat(lengths[1], 0);
  expect_flat(Ready(job_text(whitted(2), pinhole("[-1,0,1]", "[0,0,2]"), 1, objects)).sample(0, 0, 0).value, 0);
}

// Among mirrors and glass alone it agrees with a path tracer, dispersion included; branches that are not refracted keep their
// wavelengths.
TEST(WhittedRenderer, AgreesWithThePathTracerAmongMirrorsAndGlass) {
  const std::string objects = R"(
    Sphere { centre: [0,0,0], radius: 1, shader: Dielectric { ior: glass("N-SF11") } }
    Sphere { centre: [0.2,0.1,0.1], radius: 0.4, priority: 1, shader: Dielectric { ior: glass("N-BK7") } }
    Sphere { centre: [1.5,0,-1], radius: 0.7, shader: PerfectSpecular { color: rgb(0.9, 0.6, 0.3) } }
    Rectangle { corner: [-3,-3,-3], edge_u: [6,0,0], edge_v: [0,6,0], emission: DiffuseEmission { radiance: rgb(1, 0.2, 2) } }
    Environment { emission: DiffuseEmission { radiance: 0.5, sides: both } })";
  const std::string camera = "PerspectiveCamera { from: [0,0,4], to: [0,0,0], up: [0,1,0], fov: 40 deg }";
  EXPECT_GT(agreement("WhittedRenderer { max_depth: 6, samples: 1000, sampler: IndependentSampler {} }",
                      "PathTracer { max_depth: 6, samples: 4000, sampler: IndependentSampler {} }", camera, 8, objects),
            1e-4);
}

}  // namespace
}  // namespace etendue::test
