// The meaning of `sides`: a surface scatters on the named sides and absorbs on the other; holes, boundaries of media and null
// scattering are the same from both sides. Tested with every renderer, and so with shadow rays and light paths.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/render_support.h"

namespace etendue::test {
namespace {

const std::string sky = "Environment { emission: EnvironmentEmission { radiance: 1 } }\n";

/// The radiance of a plate in the plane z = 0, whose front faces +z, in a uniform environment of radiance 1.
double in_furnace(const std::string& renderer, bool from_front, const std::string& plate, double* error) {
  const Measured m = measure(job_text(
      renderer,
      fmt::format("OrthographicCamera {{ from: [0, 0, {}], to: [0, 0, 0], up: [0, 1, 0], width: 0.1 }}", from_front ? 5 : -5),
      4, "Rectangle { corner: [-1, -1, 0], edge_u: [2, 0, 0], edge_v: [0, 2, 0], " + plate + " }\n" + sky));
  *error = m.error;
  return m.mean.y;
}

void expect(const std::string& plate, double front, double back, std::vector<std::string> renderers = {}) {
  if (renderers.empty())
    renderers = {"PathTracer { samples: 256 }", "BidirectionalPathTracer { samples: 256, max_depth: 8 }",
                 "DistributionRenderer { samples: 64 }", "DirectRenderer { samples: 256 }"};
  for (const std::string& r : renderers) {
    double error = 0;
    const double seen_front = in_furnace(r, true, plate, &error);
    EXPECT_NEAR(seen_front, front, 4.5 * error + 1e-4) << plate << " from the front by " << r;
    const double seen_back = in_furnace(r, false, plate, &error);
    EXPECT_NEAR(seen_back, back, 4.5 * error + 1e-4) << plate << " from the back by " << r;
  }
}

const std::vector<std::string> with_whitted = {
    "PathTracer { samples: 256 }", "BidirectionalPathTracer { samples: 256, max_depth: 8 }",
    "DistributionRenderer { samples: 64 }", "DirectRenderer { samples: 256 }", "WhittedRenderer { samples: 64 }"};

TEST(Sides, HolesAreHolesFromBothSides) {
  expect("sides: front, shader: MaskShader { shader: Lambertian { color: 0.5 }, opacity: 0 }", 1, 1, with_whitted);
  expect("sides: back, shader: MaskShader { shader: Lambertian { color: 0.5 }, opacity: 0 }", 1, 1, with_whitted);
  expect("sides: front, shader: MaskShader { shader: Lambertian { color: 0 }, opacity: 0.5 }", 0.5, 0.5, with_whitted);
  expect("sides: front, shader: MaskShader { shader: Lambertian { color: 1 }, opacity: 0.25 }", 1, 0.75);
  expect("sides: back, shader: MaskShader { shader: Lambertian { color: 1 }, opacity: 0.25 }", 0.75, 1);
}

TEST(Sides, MixturesKeepWhatGoesStraightOn) {
  expect("sides: front, shader: PassThrough {}", 1, 1, with_whitted);
  expect("sides: front, shader: MixShader { first: PassThrough {}, second: Lambertian { color: 1 }, amount: 0.4 }", 1, 0.6);
  expect("sides: front, shader: Lambertian { color: 1 }", 1, 0);
}

TEST(Sides, ThinPanesReflectOnOneSideAndAreTransparentFromBoth) {
  const double r = 0.04, through = (1 - r) / (1 + r);
  expect("sides: both, shader: ThinDielectric { ior: 1.5 }", 1, 1, with_whitted);
  expect("sides: front, shader: ThinDielectric { ior: 1.5 }", 1, through, with_whitted);
  expect("sides: back, shader: ThinDielectric { ior: 1.5 }", through, 1, with_whitted);
}

TEST(Sides, NothingIsRefractedOrLetThroughDiffusely) {
  expect("sides: front, shader: Dielectric { ior: 1.5 }", 0.04, 0, with_whitted);
  expect("sides: front, shader: DiffuseTransmitter { reflectance: 0.3, transmittance: 0.7 }", 0.3, 0);
}

// A one-sided boundary bounds its medium from both sides.
TEST(Sides, BoundsOfMedia) {
  for (const char* sides : {"front", "back", "both"})
    for (const char* r : {"PathTracer { samples: 64 }", "BidirectionalPathTracer { samples: 64, max_depth: 8 }"}) {
      const Measured m = measure(job_text(
          r, "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 1e-3 }", 4,
          fmt::format("Sphere {{ sides: {}, shader: PassThrough {{}}, interior: HomogeneousVolume {{ absorption: 1 }} }}\n",
                      sides) +
              sky));
      EXPECT_NEAR(m.mean.y, std::exp(-2.0), 4.5 * m.error + 1e-4) << sides << " by " << r;
    }
}

// A sun behind a screen with holes lights a plate with half of its light, whichever side of the screen scatters: by shadow
// rays, light paths and connections.
TEST(Sides, LightThroughHoles) {
  for (const char* sides : {"front", "back", "both"})
    for (const char* r : {"PathTracer { samples: 64 }", "BidirectionalPathTracer { samples: 256, max_depth: 8 }",
                          "DistributionRenderer { samples: 16 }", "DirectRenderer { samples: 64 }",
                          "WhittedRenderer { samples: 16 }", "LightTracer { samples: 65536, max_depth: 8 }"}) {
      const Measured m = measure(job_text(
          r, "OrthographicCamera { from: [0, 0, 0.5], to: [0, 0, 0], up: [0, 1, 0], width: 3.9 }", 4,
          fmt::format(
              "Rectangle {{ corner: [-2, -2, 1], edge_u: [4, 0, 0], edge_v: [0, 4, 0], sides: {}, shader: MaskShader {{ "
              "shader: Lambertian {{ color: 0 }}, opacity: 0.5 }} }}\n"
              "Rectangle {{ corner: [-2, -2, 0], edge_u: [4, 0, 0], edge_v: [0, 4, 0], shader: Lambertian {{ color: 0.5 }} "
              "}}\n"
              "Distant {{ direction: [0, 0, -1], emission: DiffuseEmission {{ radiance: 3.14159265 }} }}\n",
              sides)));
      EXPECT_NEAR(m.mean.y, 0.25, 4.5 * m.error + 1e-4) << sides << " by " << r;
    }
}

}  // namespace
}  // namespace etendue::test
