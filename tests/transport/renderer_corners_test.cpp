// Corner cases of renderers: alpha surfaces on the last segment, different numbers of samples per strategy, surfaces seen
// through panes, smooth normals, limited distances.

#include <gtest/gtest.h>

#include "support/component_test_support.h"
#include "support/simple_renderers_support.h"

namespace etendue::test {
namespace {

const std::string straight_down = "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 0.01 }";
const std::string low = "OrthographicCamera { from: [0, 0, 0.5], to: [0, 0, 0], up: [0, 1, 0], width: 0.01 }";

std::string plate(double half, double z, const std::string& members) {
  return fmt::format("Rectangle {{ corner: [{0}, {0}, {1}], edge_u: [{2}, 0, 0], edge_v: [0, {2}, 0], {3} }}\n", -half, z,
                     2 * half, members);
}
const std::string holes = "shader: MaskShader { shader: Lambertian { color: 1e-6 }, opacity: 0.25 }";
const std::string lamp = "emission: DiffuseEmission { radiance: 1, sides: both }";

void expect_exactly(const std::string& renderer, const std::string& camera, const std::string& objects, double expected,
                    double tolerance = 1e-4) {
  const Measured m = measure(job_text(renderer, camera, 4, objects));
  EXPECT_EQ(m.bad, 0u);
  EXPECT_NEAR(m.mean.y, expected, 4.5 * m.error + tolerance * expected + 1e-7) << renderer << ", standard error " << m.error;
  EXPECT_LE(m.error, 0.01 * expected + 1e-7) << renderer;
}

// Null scattering does not count as a segment: alpha surfaces may be passed on the last one, before lamps and after mirrors.
TEST(RendererCorners, AlphaSurfacesOnTheLastSegment) {
  const std::string before = plate(1, 1, holes) + plate(1, 2, holes) + plate(1, 0, lamp);
  for (const char* renderer :
       {"WhittedRenderer { max_depth: 1, samples: 64 }", "DistributionRenderer { max_depth: 1, samples: 4096 }",
        "PathTracer { max_depth: 1, samples: 4096 }", "BidirectionalPathTracer { max_depth: 1, samples: 4096 }"})
    expect_exactly(renderer, straight_down, before, 0.75 * 0.75);
  // Up to a mirror and back down through a pane with holes to a lamp: two segments.
  const std::string mirror = plate(1, 0, "shader: PerfectSpecular { color: 0.8 }") + plate(1, 2, holes) + plate(1, 6, lamp);
  for (const char* renderer :
       {"WhittedRenderer { max_depth: 2, samples: 64 }", "DistributionRenderer { max_depth: 2, samples: 4096 }",
        "PathTracer { max_depth: 2, samples: 4096 }", "BidirectionalPathTracer { max_depth: 2, samples: 4096 }"})
    expect_exactly(renderer, straight_down, mirror, 0.8 * 0.75 * 0.75);
  for (const char* renderer :
       {"WhittedRenderer { max_depth: 1 }", "DistributionRenderer { max_depth: 1 }", "PathTracer { max_depth: 1 }"})
    EXPECT_EQ(measure(job_text(renderer, straight_down, 4, mirror)).mean.y, 0) << renderer;
  // An alpha surface that reflects direct light, on the last segment but one and on the last.
  const std::string lit = plate(1, 0, "shader: MaskShader { shader: Lambertian { color: 1 }, opacity: 0.25 }") +
                          "Point { position: [0, 0, 4], emission: DiffuseEmission { radiance: 1 } }";
  expect_exactly("WhittedRenderer { max_depth: 2 }", low, lit, 0.25 / M_PI / 16, 2e-4);
  for (const char* renderer :
       {"WhittedRenderer { max_depth: 1 }", "DistributionRenderer { max_depth: 1 }", "PathTracer { max_depth: 1 }"})
    EXPECT_EQ(measure(job_text(renderer, low, 4, lit)).mean.y, 0) << renderer;
}

// Different numbers of luminaire samples and shader samples: the weights of both strategies add up to 1 for any numbers. A
// rectangle 2 x 2 at height 1 over a diffuse point (1.740840 / pi), and a glossy surface under uniform light from all
// directions.
TEST(RendererCorners, CountsOfSamplesThatDiffer) {
  const std::string scene =
      plate(9, 0, "shader: Lambertian { color: 1 }") + plate(1, 1, "emission: DiffuseEmission { radiance: 1, sides: back }");
  const double expected = 1.740840 / M_PI;
  for (const char* counts : {"light_samples: 1, shader_samples: 1", "light_samples: 3, shader_samples: 1",
                             "light_samples: 1, shader_samples: 4", "light_samples: 2, shader_samples: 5"})
    for (const char* heuristic : {"balance", "power"})
      expect_exactly(fmt::format("DirectRenderer {{ {}, heuristic: {}, samples: 4096 }}", counts, heuristic), low, scene,
                     expected, 5e-4);
  for (const char* counts :
       {"light_samples: 1, diffuse_samples: 1", "light_samples: 4, diffuse_samples: 1", "light_samples: 1, diffuse_samples: 5"})
    expect_exactly(fmt::format("DistributionRenderer {{ {}, max_depth: 2, samples: 4096 }}", counts), low, scene, expected,
                   5e-4);

  // Phong along the normal reflects kd + ks of uniform light; each direction could come from the diffuse or the glossy lobe.
  const std::string glossy = plate(9, 0, "shader: PhongShader { color: 0.3, specular: 0.5, exponent: 9 }") +
                             "Environment { emission: DiffuseEmission { radiance: 1, sides: both } }";
  for (const char* counts :
       {"light_samples: 1, diffuse_samples: 1, glossy_samples: 1", "light_samples: 1, diffuse_samples: 1, glossy_samples: 4",
        "light_samples: 2, diffuse_samples: 3, glossy_samples: 1", "light_samples: 3, diffuse_samples: 2, glossy_samples: 3",
        "light_samples: 3, diffuse_samples: 0, glossy_samples: 3", "light_samples: 3, diffuse_samples: 2, glossy_samples: 0"})
    expect_exactly(fmt::format("DistributionRenderer {{ {}, max_depth: 2, samples: 4096 }}", counts), low, glossy, 0.8, 5e-4);
  for (const char* counts : {"light_samples: 1, shader_samples: 3", "light_samples: 3, shader_samples: 1"})
    expect_exactly(fmt::format("DirectRenderer {{ {}, samples: 4096 }}", counts), low, glossy, 0.8, 5e-4);
}

// A pane of index 1 with the transmittance color^(1 / cos), between a diffuse floor and a uniform environment: shadow rays and
// shader directions both cross the pane. E is the integral of 2 c 0.6^(1 / c) dc.
TEST(RendererCorners, PanesBetweenSurfacesAndLamps) {
  double expected = 0;
  for (int i = 0; i < 100000; ++i) {
    const double c = (i + 0.5) / 1e5;
    expected += 2 * c * std::pow(0.6, 1 / c) / 1e5;
  }
  const std::string scene = plate(1, 0, "shader: Lambertian { color: 1 }") +
                            plate(9000, 1, "shader: ThinDielectric { ior: 1, color: 0.6 }") +
                            "Environment { emission: DiffuseEmission { radiance: 1, sides: both } }";
  for (const char* renderer :
       {"DirectRenderer { strategy: light, samples: 8192 }", "DirectRenderer { strategy: shader, samples: 8192 }",
        "DirectRenderer { strategy: both, samples: 8192 }", "DistributionRenderer { max_depth: 2, samples: 4096 }",
        "PathTracer { max_depth: 2, samples: 8192 }", "PathTracer { max_depth: 2, next_event: false, samples: 8192 }",
        "BidirectionalPathTracer { max_depth: 2, samples: 8192 }"})
    expect_exactly(renderer, low, scene, expected, 1e-3);
}

/// A square whose shading normals are all tilted by an angle towards +x.
std::string tilted(double degrees) {
  const double x = std::sin(degrees * M_PI / 180), z = std::cos(degrees * M_PI / 180);
  const std::string n = fmt::format("[{}, 0, {}]", x, z);
  return fmt::format(
      "TriangleMesh {{ positions: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], normals: [{0}, {0}, {0}, {0}], "
      "triangles: [[0, 1, 2], [0, 2, 3]], shader: Lambertian {{ color: 1 }} }}\n",
      n);
}

// Around a normal that is tilted by a, the geometric surface occludes (1 - cos a) / 2 of a cosine lobe.
TEST(RendererCorners, SmoothNormals) {
  for (const double degrees : {20.0, 50.0}) {
    const double c = std::cos(degrees * M_PI / 180);
    expect_exactly("AmbientOcclusionRenderer { rays: 64, samples: 256 }", straight_down, tilted(degrees), (1 + c) / 2, 1e-3);
    const auto feature = [&](const char* name) {
      return Ready(job_text(fmt::format("FeatureRenderer {{ feature: {} }}", name), straight_down, 2, tilted(degrees)))
          .rgb(0, 0);
    };
    EXPECT_NEAR(double(feature("facing").x), c, 1e-4);
    EXPECT_NEAR(double(feature("shading_normal").x), 0.5 + 0.5 * std::sin(degrees * M_PI / 180), 1e-4);
    EXPECT_NEAR(double(feature("shading_normal").z), 0.5 + 0.5 * c, 1e-4);
    EXPECT_NEAR(double(feature("normal").x), 0.5, 1e-4);
    EXPECT_NEAR(double(feature("normal").z), 1, 1e-4);
  }
}

// Under a ceiling at the height 1, rays of length d hit it where cos > 1 / d: 1 - 1 / d^2 of the cosine-weighted hemisphere.
TEST(RendererCorners, OcclusionOfALimitedDistance) {
  const std::string room = plate(50, 0, "shader: Lambertian {}") + plate(50, 1, "shader: Lambertian {}");
  for (const double d : {0.9, 1.2, 2.0})
    expect_exactly(fmt::format("AmbientOcclusionRenderer {{ rays: 64, samples: 1024, distance: {} }}", d), low, room,
                   d < 1 ? 1 : 1 / (d * d), 1e-3);
}

// Depth is measured from the camera, also beyond boundaries that are hidden by an object of higher priority.
TEST(RendererCorners, DepthPastHiddenBoundaries) {
  const std::string objects =
      "Sphere { radius: 3, shader: Dielectric {}, interior: HomogeneousVolume { absorption: 0.1 }, priority: 2 }\n"
      "Sphere { centre: [0, 0, 1], radius: 0.5, shader: Dielectric {}, interior: HomogeneousVolume { absorption: 0.1 }, "
      "priority: 1 }";
  const std::string camera = "PerspectiveCamera { from: [0, 0, 0], to: [0, 0, 1], up: [0, 1, 0], fov: 0.01 }";
  const Vector3 depth = Ready(job_text("FeatureRenderer { feature: depth }", camera, 2, objects)).rgb(0, 0);
  EXPECT_NEAR(depth.x, 3, 1e-3f);
}

// Fog: single scattering needs two segments, and with one there is no light: rows 16 and 17 of a slab of optical thickness 1
// under a beam, seen along the normal. Paths of two segments have all single scattering.
TEST(RendererCorners, DepthInFog) {
  const std::string slab =
      "Box { centre: [0, 0, -0.5], size: [400, 400, 1], shader: PassThrough {}, interior: HomogeneousVolume { scattering: 1 } "
      "}\n";
  const std::string beam = "Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: 1 } }";
  const std::string above = "OrthographicCamera { from: [0, 0, 1], to: [0, 0, 0], up: [0, 1, 0], width: 0.1 }";
  for (const char* renderer : {"PathTracer", "BidirectionalPathTracer"}) {
    expect_exactly(fmt::format("{} {{ max_depth: 2, samples: 4096 }}", renderer), above, slab + beam, 0.034404, 5e-4);
    EXPECT_EQ(measure(job_text(fmt::format("{} {{ max_depth: 1, samples: 16 }}", renderer), above, 4, slab + beam)).mean.y, 0);
  }
}

}  // namespace
}  // namespace etendue::test
