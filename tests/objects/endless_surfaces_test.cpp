// Lights at infinity on unbounded surfaces, which extend beyond the sphere in which light paths begin: known results for all
// renderers that trace light paths, and tile by tile the same picture with all renderers.

#include <gtest/gtest.h>

#include "support/closed_form_rows.h"

namespace etendue::closed_form {
namespace {

const std::string plane = "InfinitePlane { shader: Lambertian { color: 0.5 } }\n",
                  sun = "Distant { direction: [0.8, 0, -0.6], emission: DiffuseEmission { radiance: 10 } }\n",
                  sky = "Environment { emission: DiffuseEmission { radiance: 2 } }\n",
                  ball = "Sphere { centre: [0, 0, 0.3], radius: 0.3, shader: Lambertian { color: 0.6 } }\n";

// Where nothing but the plane reflects, its radiance is rho E / pi: rho L under a sky of radiance L, and rho S cos / pi under a
// sun whose irradiance perpendicular to its light is S. The camera sees parts of the plane at 2 to 30 and at 2000 radii of the
// scene, which is R = 1, since there is nothing but the plane.
std::vector<Row> rows() {
  const std::string near = "PerspectiveCamera { from: [0, -3, 2], to: [0, 1, 1], up: [0, 0, 1], fov: 20 }",
                    far = "PerspectiveCamera { from: [2000, 0, 2], to: [2000, 1, 0], up: [0, 0, 1], fov: 40 }",
                    two = "max_depth: 2";
  const std::vector<Way> ways = {{"PathTracer", two, 4}, {"BidirectionalPathTracer", two, 16}, {"LightTracer", two, 3072}};
  const std::vector<Way> eye = {{"PathTracer", two, 4}, {"BidirectionalPathTracer", two, 16}};
  return {{"SkyNear", near, plane + sky, 1, ways},
          {"SunNear", near, plane + sun, 3 / exact_pi, ways},
          {"SkyFar", far, plane + sky, 1, eye},
          {"SunFar", far, plane + sun, 3 / exact_pi, eye},
          // The plane above the scene's sphere occludes the sun. As any light at all is an error, a hundredth of the paths is
          // enough: half a million light subpaths, of which none may contribute.
          {"SunAboveARoof",
           near,
           plane + "InfinitePlane { transform: translate(0, 0, 4) }\n" + sun,
           0.0,
           {{"PathTracer", two, 4}, {"BidirectionalPathTracer", two, 16}, {"LightTracer", two, 64}}}};
}

class EndlessSurfaces : public testing::TestWithParam<Case> {};
TEST_P(EndlessSurfaces, ReflectAKnownLight) { expect_row(GetParam()); }
INSTANTIATE_TEST_SUITE_P(All, EndlessSurfaces, testing::ValuesIn(cases(rows())),
                         [](const auto& each) { return each.param.row.name + "_" + each.param.way.renderer; });

constexpr int width = 24, height = 16, tile = 4, passes = 16, tiles = (width / tile) * (height / tile);

/// Mean and squared standard error of each tile, over renders with different seeds.
struct Tiles {
  double mean[tiles] = {}, variance[tiles] = {};
};

Tiles measured(const std::string& renderer, const std::string& objects) {
  Render render(load_job_text("Job {\n renderer: " + renderer + R"(
    camera: PerspectiveCamera { from: [0, -3, 1.5], to: [0, 0, 0.6], up: [0, 0, 1], fov: 50 }
    image: ImageBuffer { width: 24, height: 16, filter: BoxFilter {} }
    scene: EmbreeScene { objects: [ )" +
                                  objects + "] }\n}\n",
                              "tiles.etd"));
  Tiles t;
  for (int pass = 0; pass < passes; ++pass) {
    test::render_again(render, std::uint64_t(pass + 1));
    const Image image = render.film().develop();
    double sums[tiles] = {};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) sums[y / tile * (width / tile) + x / tile] += image.at(x, y, 1) / (tile * tile);
    for (int k = 0; k < tiles; ++k) {
      t.mean[k] += sums[k] / passes;
      t.variance[k] += sums[k] * sums[k] / passes;
    }
  }
  for (int k = 0; k < tiles; ++k) t.variance[k] = std::max(t.variance[k] - t.mean[k] * t.mean[k], 0.0) / (passes - 1);
  return t;
}

// 5.5 standard errors of a difference with about 30 degrees of freedom: probability 6e-6 for each tile, 6e-4 for all of them.
void expect_same(const std::string& renderer, int samples, const std::string& objects, double notice = 0.02) {
  const Tiles a = measured("PathTracer { max_depth: 3, samples: 64 }", objects),
              b = measured(renderer + " { max_depth: 3, samples: " + std::to_string(samples) + " }", objects);
  for (int k = 0; k < tiles; ++k) {
    const double error = std::sqrt(a.variance[k] + b.variance[k]);
    EXPECT_NEAR(b.mean[k], a.mean[k], 5.5 * error + 1e-4 * a.mean[k]) << renderer << ", tile " << k;
    EXPECT_LT(error, notice * a.mean[k] + 1e-12) << "too few samples to tell, tile " << k;
  }
}

TEST(EndlessSurfaces, AroundABallBidirectionalUnderASky) { expect_same("BidirectionalPathTracer", 32, plane + ball + sky); }
TEST(EndlessSurfaces, AroundABallBidirectionalUnderASun) { expect_same("BidirectionalPathTracer", 32, plane + ball + sun); }
TEST(EndlessSurfaces, AroundABallLightPathsUnderASun) { expect_same("LightTracer", 256, plane + ball + sun, 0.1); }

}  // namespace
}  // namespace etendue::closed_form
