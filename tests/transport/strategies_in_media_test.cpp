// Transmittance and null scattering in the throughput of paths, by every strategy taken alone.
//
// A lamp, a floor and the lens are within one absorbing medium: light travels from the lamp to a point of the floor and on to
// the lens, and is attenuated by exp(-a s) on both segments. Each strategy of each renderer, taken alone, must find it. The
// floor's radiance is E / pi, where E is an integral over the lamp.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "etendue/describe/color.h"
#include "support/component_test_support.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

constexpr double half = 0.5, lamp_half = 0.4, height = 1.2, lens_height = 0.7;

double absorption(double l) { return 0.4 + 2 * (l - 360) / 470; }

/// The mean Y over the floor's square, by the midpoint rule on the floor, the lamp and the wavelengths.
double expected() {
  constexpr int n = 12, steps = 94;
  std::vector<double> ways;  // lengths of the paths, and their contributions without absorption
  std::vector<double> parts;
  const auto at = [](int i, double h) { return h * (2 * (i + 0.5) / n - 1); };
  for (int i = 0; i < n * n; ++i)
    for (int k = 0; k < n * n; ++k) {
      const double x = at(i % n, half) - at(k % n, lamp_half), y = at(i / n, half) - at(k / n, lamp_half);
      const double d2 = x * x + y * y + height * height, cosine = height / std::sqrt(d2);
      ways.push_back(std::sqrt(d2) + lens_height);
      parts.push_back(cosine * cosine / d2 / M_PI * std::pow(2 * lamp_half, 2) / std::pow(n, 4));
    }
  double sum = 0, norm = 0;
  for (int s = 0; s < steps; ++s) {
    const double l = 360 + 470 * (s + 0.5) / steps, y = observer(float(l)).y;
    double light = 0;
    for (size_t i = 0; i < ways.size(); ++i) light += parts[i] * std::exp(-absorption(l) * ways[i]);
    sum += y * light;
    norm += y;
  }
  return sum / norm;
}

TEST(StrategiesInMedia, EachAloneFindsTheLight) {
  const std::string objects =
      "Sphere { radius: 9, shader: PassThrough {}, interior: HomogeneousVolume { absorption: spectrum([360, 830], [0.4, 2.4]) "
      "} "
      "}\n" +
      fmt::format(
          "Rectangle {{ corner: [-3, -3, 0], edge_u: [6, 0, 0], edge_v: [0, 6, 0], shader: Lambertian {{ color: 1 }} }}\n"
          "Rectangle {{ corner: [-{0}, -{0}, {1}], edge_u: [{2}, 0, 0], edge_v: [0, {2}, 0], emission: DiffuseEmission {{ "
          "radiance: 1, sides: back }} }}\n",
          lamp_half, height, 2 * lamp_half);
  const std::string camera =
      fmt::format("OrthographicCamera {{ from: [0, 0, {}], to: [0, 0, 0], up: [0, 1, 0], width: {} }}", lens_height, 2 * half);
  const double mean = expected();
  const auto alone = [](int s, int t) {
    return fmt::format("BidirectionalPathTracer {{ weighted: false, light_vertices: {}, camera_vertices: {}, ", s, t);
  };
  for (const auto& [renderer, samples] : {std::pair<std::string, int>("PathTracer { ", 256),
                                          {"PathTracer { next_event: false, ", 4096},
                                          {"LightTracer { ", 4096},
                                          {alone(0, 3), 4096},
                                          {alone(1, 2), 256},
                                          {alone(2, 1), 4096},
                                          {"BidirectionalPathTracer { ", 1024},
                                          {"BidirectionalPathTracer { heuristic: balance, ", 1024}}) {
    const Measured m =
        measure(job_text(renderer + fmt::format("max_depth: 2, samples: {} }}", samples), camera, 8, objects, "EmbreeScene"));
    EXPECT_NEAR(m.mean.y, mean, 4.5 * m.error + 5e-4 * mean) << renderer;
    EXPECT_LT(m.error, 0.008 * mean) << renderer;
  }
}

// A white ball half of whose surface is holes, in a white furnace: the radiance seen from within is 1, for any number of null
// scatterings.
TEST(StrategiesInMedia, AWhiteBallWithHolesInAFurnace) {
  const std::string objects =
      "Sphere { shader: MaskShader { shader: Lambertian { color: 1 }, opacity: 0.5 } }\n"
      "Environment { emission: DiffuseEmission { radiance: 1 } }";
  const std::string camera = "PerspectiveCamera { from: [0.2, 0.1, 0], to: [1, 0.2, 0.1], fov: 60 }";
  for (const char* renderer :
       {"PathTracer { max_depth: 1000, samples: 1024 }", "PathTracer { max_depth: 1000, samples: 1024, next_event: false }",
        "BidirectionalPathTracer { max_depth: 1000, samples: 1024 }"}) {
    const Measured m = measure(job_text(renderer, camera, 8, objects, "EmbreeScene"));
    EXPECT_NEAR(m.mean.y, 1, 4.5 * m.error + 5e-4) << renderer;
    EXPECT_LT(m.error, 0.004) << renderer;
  }
}

}  // namespace
}  // namespace etendue::test
