// Light through mirrors and glass by ManifoldPathTracer, against closed forms and against path tracing; derivatives of chains
// against differences of traced rays.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "etendue/transport/primary_sample_vectors.h"
#include "etendue/transport/specular_chain.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using test::job_text;

constexpr double exact_pi = 3.141592653589793;
const std::string matt = "Lambertian { color: 0.5 }";

/// Intensity of a Point with radiance 1 [W/sr]: see Extent.
std::string point_at(const char* position) {
  return fmt::format("Point {{ position: {}, emission: DiffuseEmission {{ radiance: 1 }} }}\n", position);
}

/// The mean over the square of half width h around (x, y) of f(distance from the origin).
double mean_around(double x, double y, double h, const std::function<double(double, double)>& f) {
  constexpr int steps = 40;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) sum += f(x + h * ((2 * i + 1.0) / steps - 1), y + h * ((2 * k + 1.0) / steps - 1));
  return sum / (steps * steps);
}

/// The mean Y of a picture, which must be `expected` times that of a radiance of 1, within 1 % and 4.5 standard errors.
void expect_mean(const std::string& renderer, const std::string& camera, const std::string& objects, double expected) {
  const test::Measured m = test::measure(job_text(renderer, camera, 8, objects, "EmbreeScene"));
  const test::Measured one = test::measure(
      job_text("PathTracer { samples: 16 }", "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 1 }",
               2, "Environment { emission: DiffuseEmission { radiance: 1 } }"));
  EXPECT_EQ(m.bad, 0u);
  const double mean = double(m.mean.y) / double(one.mean.y), error = m.error / double(one.mean.y);
  EXPECT_LT(error, 0.01 * expected);
  EXPECT_NEAR(mean, expected, 4.5 * error + 5e-4 * expected) << "standard error " << error;
}

// A point light before a mirror of reflectance 0.8 is two point lights.
TEST(ManifoldSampling, AMirrorShowsTheImageOfALamp) {
  const std::string floor = "Rectangle { corner: [-5, -5, 0], edge_u: [10, 0, 0], edge_v: [0, 10, 0], shader: " + matt + " }\n";
  const std::string mirror =
      "Rectangle { corner: [1, -5, 0], edge_u: [0, 10, 0], edge_v: [0, 0, 8], "
      "shader: PerfectSpecular { color: 0.8 } }\n";
  const double expected = 0.5 / exact_pi * mean_around(0, 0, 0.25, [](double x, double y) {
                            const auto irradiance = [&](double at) {
                              const double squared = (x - at) * (x - at) + y * y + 1;
                              return 1 / (squared * std::sqrt(squared));
                            };
                            return irradiance(0.5) + 0.8 * irradiance(1.5);
                          });
  expect_mean("ManifoldPathTracer { max_depth: 3, samples: 768 }",
              "OrthographicCamera { from: [0, 0, 0.5], to: [0, 0, 0], up: [0, 1, 0], width: 0.5 }",
              floor + mirror + point_at("[0.5, 0, 1]"), expected);
}

double fresnel_transmittance(double cosine, double n) {
  const double behind = std::sqrt(1 - (1 - cosine * cosine) / (n * n));
  const double s = (cosine - n * behind) / (cosine + n * behind), p = (n * cosine - behind) / (n * cosine + behind);
  return 1 - (s * s + p * p) / 2;
}

// The floor of a basin 1 m deep, under a point light 1 m above the water: the light within d theta falls on a ring,
//     E r dr = I T sin(theta) d theta,   r = tan theta + tan theta',   sin theta = n sin theta'.
double irradiance_under_water(double r) {
  constexpr double n = 1.33;
  double low = 0, high = exact_pi / 2;
  const auto behind = [&](double theta) { return std::asin(std::sin(theta) / n); };
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (std::tan(middle) + std::tan(behind(middle)) < r ? low : high) = middle;
  }
  const double theta = low, inside = behind(theta);
  const double dr = 1 / (std::cos(theta) * std::cos(theta)) +
                    std::cos(theta) / (n * std::cos(inside)) / (std::cos(inside) * std::cos(inside));
  return fresnel_transmittance(std::cos(theta), n) * std::sin(theta) / (r * dr);
}

TEST(ManifoldSampling, LightUnderWaterIsRefracted) {
  const std::string basin =
      "Box { size: [8, 8, 1.5], transform: translate(0, 0, -0.75), shader: Dielectric { ior: 1.33 } }\n"
      "Rectangle { corner: [-3, -3, -1], edge_u: [6, 0, 0], edge_v: [0, 6, 0], shader: " +
      matt + " }\n";
  const double expected =
      0.5 / exact_pi * mean_around(0.7, 0, 0.1, [](double x, double y) { return irradiance_under_water(std::hypot(x, y)); });
  for (const char* more : {"", ", unbiased: false, seeds: 24"})
    expect_mean(fmt::format("ManifoldPathTracer {{ max_depth: 3, samples: 512{} }}", more),
                "OrthographicCamera { from: [0.7, 0, -0.5], to: [0.7, 0, -1], up: [0, 1, 0], width: 0.2 }",
                basin + point_at("[0, 0, 1]"), expected);
}

// A ball lens of radius a on the axis between a point light and a floor beyond its image, where no marginal rays come to the
// axis. Near the axis a ray that leaves the light with the
// angle alpha comes to the floor at B alpha, with B of the matrix of the two refractions and the ways between
// (Born & Wolf 1999, section 4.4), so that E = I T^2 / B^2.
TEST(ManifoldSampling, ABallGathersLightOnItsAxis) {
  constexpr double n = 1.5, a = 0.5, before = 2, after = 1.5;
  double y = 0, angle = 1;
  const auto go = [&](double way) { y += angle * way; };
  go(before);
  angle = (angle - y * (n - 1) / a) / n;
  go(2 * a);
  angle = angle * n - y * (n - 1) / a;
  go(after);
  const double T = fresnel_transmittance(1, n), expected = 0.5 / exact_pi * T * T / (y * y);
  expect_mean("ManifoldPathTracer { max_depth: 4, samples: 512 }",
              "OrthographicCamera { from: [0, 0, 0.1], to: [0, 0, 0], up: [0, 1, 0], width: 0.004 }",
              "Rectangle { corner: [-1, -1, 0], edge_u: [2, 0, 0], edge_v: [0, 2, 0], shader: " + matt +
                  " }\nSphere { centre: [0, 0, 2], radius: 0.5, shader: Dielectric { ior: 1.5 } }\n" + point_at("[0, 0, 4.5]"),
              expected);
}

const std::string small_scene =
    "Rectangle { corner: [-1, -1, 0], edge_u: [2, 0, 0], edge_v: [0, 2, 0], shader: " + matt +
    " }\n"
    "Sphere { centre: [-0.35, 0, 0.31], radius: 0.3, shader: Dielectric { ior: glass(\"N-SF11\") } }\n"
    // A pyramid of two sides with interpolated normals, and a bumped mirror.
    "TriangleMesh { positions: [[0.1, -0.3, 0.3], [0.8, -0.3, 0.3], [0.45, 0.4, 0.3], [0.45, 0, 0.6], [0.45, 0, 0.02]]\n"
    "  triangles: [[0, 1, 3], [1, 2, 3], [2, 0, 3], [1, 0, 4], [2, 1, 4], [0, 2, 4]]\n"
    "  normals: [[-0.8, -0.5, 0], [0.8, -0.5, 0], [0, 1, 0], [0, 0, 1], [0, 0, -1]]\n"
    "  shader: Dielectric { ior: 1.4 }, interior: HomogeneousVolume { absorption: 1 } }\n"
    "Rectangle { corner: [-1, 0.9, 0], edge_u: [2, 0, 0], edge_v: [0, 0, 1], shader: PerfectSpecular { color: 0.9 } }\n"
    "Sphere { centre: [0.1, -0.3, 1.6], radius: 0.15, emission: DiffuseEmission { radiance: 10 } }\n";

// The same light as by path tracing, in total, and where dispersion, absorption, interpolated normals, long chains and both
// strategies for one path are involved.
TEST(ManifoldSampling, AgreesWithPathTracing) {
  const std::string camera = "PerspectiveCamera { from: [0, -3, 1.5], to: [0, 0, 0.2], up: [0, 0, 1], fov: 40 }";
  const auto mean = [&](const std::string& renderer) {
    return test::measure(job_text(renderer, camera, 24, small_scene, "EmbreeScene"));
  };
  const test::Measured by_chance = mean("PathTracer { max_depth: 8, samples: 1024 }");
  for (const char* members :
       {"samples: 96", "samples: 96, heuristic: balance, split_depth: 2", "samples: 96, chain_depth: 1"}) {
    const test::Measured m = mean(fmt::format("ManifoldPathTracer {{ max_depth: 8, {} }}", members));
    EXPECT_EQ(m.bad, 0u);
    EXPECT_NEAR(m.mean.y, by_chance.mean.y, 4 * std::hypot(m.error, by_chance.error)) << members;
  }
}

// Behind a ball of dispersive glass a lamp is found about as often by emitter hits as by chains, and for the hits the trials of
// chains are made again, at the wavelength that each branch follows.
TEST(ManifoldSampling, EachPathCountsOnce) {
  const std::string camera = "OrthographicCamera { from: [0.1, 0, 0.05], to: [0.1, 0, 0], up: [0, 1, 0], width: 0.3 }";
  const std::string objects = "Rectangle { corner: [-1, -1, 0], edge_u: [2, 0, 0], edge_v: [0, 2, 0], shader: " + matt +
                              " }\nSphere { centre: [0, 0, 0.5], radius: 0.3, shader: Dielectric { ior: glass(\"N-SF11\") } }\n"
                              "Sphere { centre: [-0.4, 0, 1.8], radius: 0.25, emission: DiffuseEmission { radiance: 10 } }\n";
  const auto mean = [&](const std::string& renderer) {
    return test::measure(job_text(renderer, camera, 8, objects, "EmbreeScene"));
  };
  const test::Measured by_chance = mean("PathTracer { max_depth: 6, samples: 8192 }");
  for (const char* members : {"", ", split_wavelengths: 1", ", heuristic: balance"}) {
    const test::Measured m = mean(fmt::format("ManifoldPathTracer {{ max_depth: 6, samples: 512{} }}", members));
    const double error = std::hypot(m.error, by_chance.error);
    EXPECT_LT(error, 0.03 * double(m.mean.y));
    EXPECT_NEAR(m.mean.y, by_chance.mean.y, 4 * error) << members;
  }
}

// J of chains from a point of the floor that end at a target, against differences of r.
TEST(ManifoldSampling, DerivativesOfChainsAreThoseOfTracedRays) {
  Render render(load_job_text(job_text("PathTracer {}", "OrthographicCamera {}", 2, small_scene, "EmbreeScene"), "chain.etd"));
  const Scene& scene = *render.job().scene;
  struct Case {
    Point3 from, through;
    std::vector<Lobe> lobes;
  };
  const std::vector<Case> all = {
      {{-0.5f, 0.1f, 0}, {-0.4f, 0.05f, 0.3f}, {specular_transmission, specular_transmission}},
      {{-0.5f, 0.4f, 0}, {-0.4f, 0.1f, 0.3f}, {specular_reflection}},
      {{-0.5f, 0.1f, 0}, {-0.3f, 0.1f, 0.35f}, {specular_transmission, specular_reflection, specular_transmission}},
      {{0.4f, -0.15f, 0}, {0.42f, -0.1f, 0.15f}, {specular_transmission, specular_transmission}},
      {{0.2f, -0.5f, 0}, {0.4f, -0.2f, 0.4f}, {specular_reflection}},
      {{0.3f, 0.2f, 0}, {0.1f, 0.9f, 0.4f}, {specular_reflection}},
  };
  const MutatedPrimarySamples numbers_source(1);
  NumberStream numbers(numbers_source, SampleKey(1, 0, 0, 0));
  std::array<float, spectrum_size> lambda, pdf;
  lambda.fill(550);
  pdf.fill(0.01f);
  const Wavelengths wavelengths(lambda, pdf);
  Arena arena;
  int compared = 0;
  for (const Case& c : all)
    for (const bool infinite : {false, true}) {
      PathVertex receiver;
      receiver.point.position = c.from;
      receiver.point.normal = receiver.point.shading_normal = {0, 0, 1};
      receiver.out = {0, 0, 1};
      ChainLobes lobes;
      for (const Lobe lobe : c.lobes) lobes.add(lobe);
      ChainTarget target;
      target.infinite = infinite;
      const auto residual = [&](const Vector3& w, ChainSolution& at, double r[2]) {
        ChainTracer chain(scene, wavelengths, numbers, arena);
        chain.derivatives = ChainTracer::Derivatives::exact;
        chain.begin(receiver, w);
        if (!chain.follow(lobes)) return false;
        chain_residual(chain, target, at, r);
        return true;
      };
      const Vector3 w = normalize(c.through - c.from);
      const Frame across{Normal3(w)};
      ChainTracer ended(scene, wavelengths, numbers, arena);
      ended.begin(receiver, w);
      ASSERT_TRUE(ended.follow(lobes)) << c.lobes.size();
      target.direction = ended.ray.direction;
      target.position = ended.from + 1.2f * ended.ray.direction;
      ChainSolution here, other;
      double r[2], more[2], less[2];
      ASSERT_TRUE(residual(w, here, r)) << c.lobes.size();
      EXPECT_LT(std::hypot(r[0], r[1]), 1e-6);
      constexpr float step = 3e-4f;
      for (int k = 0; k < 2; ++k) {
        const Vector3 side = k == 0 ? across.s : across.t;
        ASSERT_TRUE(residual(normalize(w + step * side), other, more));
        ASSERT_TRUE(residual(normalize(w - step * side), other, less));
        for (int i = 0; i < 2; ++i) {
          const double difference = (more[i] - less[i]) / (2 * double(step));
          EXPECT_NEAR(here.jacobian[i][k], difference, 0.004 * std::abs(difference) + 0.004)
              << i << k << " of " << c.lobes.size();
        }
        ++compared;
      }
    }
  EXPECT_EQ(compared, 24);
}

TEST(ManifoldSampling, SaysWhatItFinds) {
  const auto finds = [](const std::string& members) {
    const Ref<Job> job =
        load_job_text(job_text("ManifoldPathTracer { " + members + " }", "OrthographicCamera {}", 2, small_scene), "f.etd");
    return job->renderer->finds();
  };
  EXPECT_TRUE(finds("") & delta_caustics_in_mirrors);
  EXPECT_FALSE(finds("") & delta_caustics_of_panes);
  EXPECT_TRUE(finds("max_depth: 4, chain_depth: 2") & delta_caustics_of_bodies);
  EXPECT_FALSE(finds("max_depth: 5, chain_depth: 2") & delta_caustics);
}

}  // namespace
}  // namespace etendue
