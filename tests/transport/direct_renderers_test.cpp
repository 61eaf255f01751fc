// DirectRenderer and DistributionRenderer.
// Statistical tests use fixed seeds and hold at 4.5 standard errors (two-sided 7e-6 each), unless they say otherwise.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/simple_renderers_support.h"

namespace etendue::test {
namespace {

struct Setup {
  const char* name;
  std::string camera, objects;
  double expected;
};

/// Rows of the table of closed forms: form factors, with receivers of reflectance 1, and irradiance over pi.
std::vector<Setup> direct_light_setups() {
  const std::string from_above = "OrthographicCamera { from: [0.5,0.5,0.5], to: [0.5,0.5,0], up: [0,1,0], width: 1 }";
  const std::string square = "Rectangle { corner: [0,0,0], edge_u: [1,0,0], edge_v: [0,1,0], " + diffuse + " }\n";
  return {
      {"parallel squares", from_above,
       square + "Rectangle { corner: [0,0,1], edge_u: [1,0,0], edge_v: [0,1,0], emission: " + lit + " }", 0.199825},
      {"squares at right angles", from_above,
       square + "Rectangle { corner: [0,0,0], edge_u: [0,1,0], edge_v: [0,0,1], emission: " + lit + " }", 0.200044},
      {"discs", "OrthographicCamera { from: [0,0,0.5], to: [0,0,0], up: [0,1,0], width: 2 }",
       "Disc { radius: 1, " + diffuse + " }\nDisc { radius: 1, transform: translate(0, 0, 1), emission: " + lit + " }",
       0.381966 * double(pi) / 4},
      {"rectangle", pinhole("[0,0,0.5]", "[0,0,0]"),
       "Rectangle { corner: [-9,-9,0], edge_u: [18,0,0], edge_v: [0,18,0], " + diffuse +
           " }\nRectangle { corner: [-1,-1,1], edge_u: [2,0,0], edge_v: [0,2,0], emission: " + lit + " }",
       1.740840 / double(pi)},
      {"sphere", pinhole("[0,0.2,0.5]", "[0,0,0]"),
       "Disc { radius: 1, " + diffuse + " }\nSphere { centre: [0,0,3], radius: 1, emission: " + lit + " }",
       0.349066 / double(pi)},
      {"half a sphere", pinhole("[0,0.2,0.5]", "[0,0,0]"),
       "Disc { radius: 0.1, " + diffuse + " }\nSphere { centre: [3,0,0], radius: 1, emission: " + lit + " }",
       0.025567 / double(pi)},
  };
}

void expect_direct_light(const std::string& renderer, int samples) {
  for (const Setup& setup : direct_light_setups()) {
    SCOPED_TRACE(std::string(setup.name) + ", " + renderer);
    const std::string with_samples = renderer.substr(0, renderer.size() - 1) + ", samples: " + std::to_string(samples) + " }";
    // One direction in 120 of the shader's hits the smallest lamp, so its error is larger.
    expect_value(measure(job_text(with_samples, setup.camera, 16, setup.objects)), setup.expected,
                 setup.expected < 0.01 ? 0.1 : 0.01);
  }
}

TEST(DirectRenderer, ClosedFormsByPointsOnLuminaires) {
  expect_direct_light("DirectRenderer { strategy: light, light_samples: 2 }", 256);
}
TEST(DirectRenderer, ClosedFormsByDirectionsOfTheShader) {
  expect_direct_light("DirectRenderer { strategy: shader, shader_samples: 2 }", 512);
}
TEST(DirectRenderer, ClosedFormsByBoth) {
  for (const char* heuristic : {"balance", "power"})
    expect_direct_light(
        fmt::format("DirectRenderer {{ strategy: both, heuristic: {}, light_samples: 2, shader_samples: 3 }}", heuristic), 128);
}
TEST(DistributionRenderer, ClosedForms) {
  expect_direct_light("DistributionRenderer { max_depth: 2, light_samples: 3, diffuse_samples: 2 }", 128);
  expect_direct_light("DistributionRenderer { max_depth: 2, light_samples: 2, split_depth: 0 }", 256);
  expect_direct_light("DistributionRenderer { max_depth: 2, light_samples: 2, diffuse_samples: 0 }", 128);
}

std::string furnace() { return "Sphere { radius: 1, shader: Lambertian { color: 0.8 }, emission: " + lit + " }"; }

TEST(DistributionRenderer, FurnaceOfLimitedDepth) {  // 5 (1 - 0.8^9)
  expect_value(measure(job_text("DistributionRenderer { max_depth: 9, diffuse_samples: 3, light_samples: 2, samples: 32 }",
                                furnace_camera, 32, furnace())),
               4.32891);
  // Splitting at several surfaces.
  expect_value(measure(job_text("DistributionRenderer { max_depth: 4, split_depth: 3, diffuse_samples: 2, samples: 32 }",
                                furnace_camera, 32, furnace())),
               5 * (1 - std::pow(0.8, 4)));
}

TEST(DistributionRenderer, WithoutDiffuseRaysIsDirectLight) {  // 1 + 0.8
  expect_value(measure(job_text("DistributionRenderer { max_depth: 9, diffuse_samples: 0, samples: 32 }", furnace_camera, 32,
                                furnace())),
               1.8, 0.002);
  expect_value(measure(job_text("DirectRenderer { samples: 32 }", furnace_camera, 32, furnace())), 1.8, 0.002);
}

TEST(DistributionRenderer, AgreesWithThePathTracer) {
  const std::string path_tracer = "PathTracer { max_depth: 5, samples: 2000, sampler: IndependentSampler {} }";
  for (const char* members : {"light_samples: 3, diffuse_samples: 2, glossy_samples: 3",
                              "split_depth: 2, light_samples: 1, diffuse_samples: 3, glossy_samples: 2, "
                              "specular_samples: 2",
                              "split_depth: 0, roulette_depth: 2"}) {
    const std::string renderer =
        fmt::format("DistributionRenderer {{ max_depth: 5, samples: {}, sampler: IndependentSampler {{}}, {} }}",
                    std::string(members).starts_with("split_depth: 2") ? 400 : 600, members);
    EXPECT_GT(agreement(renderer, path_tracer, room_camera, 8, room()), 1e-4) << members;
  }
}

TEST(DirectRenderer, AgreesWithThePathTracer) {
  const std::string path_tracer = "PathTracer { max_depth: 2, samples: 2000, sampler: IndependentSampler {} }";
  for (const char* members : {"strategy: both, light_samples: 2, shader_samples: 2", "strategy: shader, shader_samples: 8"})
    EXPECT_GT(agreement(fmt::format("DirectRenderer {{ samples: 1000, sampler: IndependentSampler {{}}, {} }}", members),
                        path_tracer, room_camera, 8, room()),
              1e-4)
        << members;
}

// Half of the image shows a glossy floor under a wide lamp, where luminaire points hardly ever lie in the lobe, the other half
// a diffuse floor under a small lamp, which the shader's directions hardly ever hit.
TEST(DirectRenderer, BothStrategiesTogetherVaryLessThanEach) {
  const std::string objects = R"(
    Rectangle { corner: [-2,-1,0], edge_u: [2,0,0], edge_v: [0,2,0], shader: PhongShader { color: 0, specular: 0.5, exponent: 2000 } }
    Rectangle { corner: [0,-1,0], edge_u: [2,0,0], edge_v: [0,2,0], shader: Lambertian { color: 0.5 } }
    Rectangle { corner: [-4,-4,2], edge_u: [0,8,0], edge_v: [3.99,0,0], emission: DiffuseEmission { radiance: 1 } }
    Sphere { centre: [1,0,1.6], radius: 0.05, emission: DiffuseEmission { radiance: 1000 } })";
  const std::string camera = "OrthographicCamera { from: [0,0,1.5], to: [0,0,0], up: [0,1,0], width: 2 }";
  const auto error = [&](const std::string& strategy, int light, int shader) {
    return measure(job_text(fmt::format("DirectRenderer {{ strategy: {}, light_samples: {}, shader_samples: {}, samples: 64, "
                                        "sampler: IndependentSampler {{}} }}",
                                        strategy, light, shader),
                            camera, 16, objects))
        .error;
  };
  // The same number of rays for each.
  const double both = error("both", 1, 1), light = error("light", 2, 1), shader = error("shader", 1, 2);
  EXPECT_LT(both, 0.6 * light);
  EXPECT_LT(both, 0.6 * shader);
}

TEST(DirectRenderer, StrategiesFindWhatTheyCan) {
  const std::string floor = "Rectangle { corner: [-9,-9,0], edge_u: [18,0,0], edge_v: [0,18,0], shader: ";
  const std::string point = " }\nPoint { position: [0,0,2], emission: DiffuseEmission { radiance: 3 } }";
  const std::string camera = pinhole("[0,0,1]", "[0,0,0]");
  const auto value = [&](const char* strategy, const std::string& objects) {
    return Ready(job_text(fmt::format("DirectRenderer {{ strategy: {} }}", strategy), camera, 1, objects))
        .sample(0, 0, 0)
        .value;
  };
  // I / d^2 rho / pi = 3 / 4 / pi
  const std::string lit_floor = floor + "Lambertian { color: 1 }" + point;
  expect_flat(value("light", lit_floor), 0.75f * inverse_pi);
  expect_flat(value("both", lit_floor), 0.75f * inverse_pi);
  expect_flat(value("shader", lit_floor), 0);
  // A lamp seen in a mirror.
  const std::string mirror = floor +
                             "PerfectSpecular { color: 0.7 } }\nRectangle { corner: [-9,-9,3], edge_u: [18,0,0], "
                             "edge_v: [0,18,0], emission: DiffuseEmission { radiance: 2, sides: both } }";
  expect_flat(value("light", mirror), 0);
  expect_flat(value("both", mirror), 1.4f);
  expect_flat(value("shader", mirror), 1.4f);
}

}  // namespace
}  // namespace etendue::test
