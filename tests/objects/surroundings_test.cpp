// Surroundings: a medium, or an index of refraction, around everything; the attenuation of light in it, with every strategy
// that finds the light.

#include <fmt/format.h>

#include "support/luminaire_test_support.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

const std::string grey_fog = "interior: HomogeneousVolume { absorption: 0.25 }";

// A white disc of 1 m around the origin under a distant light from straight above, seen from straight above from 2 m. The
// scene's radius is the half diagonal of the disc's box, sqrt(2) m; light passes through twice that (reach: 2).
TEST(Surroundings, LightFromInfinityComesThroughTheirReach) {
  const std::string camera = "OrthographicCamera { from: [0, 0, 2], to: [0, 0, 0], up: [0, 1, 0], width: 0.02 }";
  const auto objects = [](const std::string& around) {
    return "Disc { shader: Lambertian { color: 1 } }\nDistant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: 1 "
           "} "
           "}\nSurroundings { " +
           around + " }\n";
  };
  const double wanted = std::exp(-0.25 * (2 + 2 * std::sqrt(2.0))) / M_PI;
  for (const auto& [renderer, samples] : {std::pair<std::string, int>("PathTracer { ", 16),
                                          {"LightTracer { ", 1 << 20},
                                          {"BidirectionalPathTracer { max_depth: 2, ", 64}}) {
    const auto seen = [&, r = renderer, n = samples](const std::string& around) {
      return measure(job_text(r + fmt::format("samples: {} }}", n), camera, 1, objects(around)));
    };
    const Measured m = seen("reach: 2, " + grey_fog);
    EXPECT_NEAR(m.mean.y, wanted, 4.5 * m.error + 1e-4 * wanted) << renderer;
    EXPECT_EQ(seen(grey_fog).mean.y, 0) << renderer;  // through an unbounded medium no light arrives
  }
}

// All scattered light leaves the medium: in a furnace fog without absorption is invisible, however far it extends.
TEST(Surroundings, FogThatAbsorbsNothingIsNotSeenInAFurnace) {
  const std::string objects =
      "Sphere { radius: 0.5, shader: Lambertian { color: 1 } }\nEnvironment { emission: DiffuseEmission { radiance: 1 } }\n"
      "Surroundings { reach: 3, interior: HomogeneousVolume { scattering: 1, anisotropy: 0.3 } }\n";
  for (const char* renderer : {"PathTracer { max_depth: 400, ", "PathTracer { next_event: false, max_depth: 400, ",
                               "BidirectionalPathTracer { max_depth: 100, "}) {
    const Measured m =
        measure(job_text(std::string(renderer) + "samples: 64 }",
                         "PerspectiveCamera { from: [0, -1.5, 0], to: [0, 0, 0], up: [0, 0, 1], fov: 60 }", 8, objects));
    EXPECT_NEAR(m.mean.y, 1, 4.5 * m.error + 2e-3) << renderer;
  }
}

// The medium ends at a sphere, wherever a ray begins: seen from outside of it, paths from both ends give the same picture. In a
// heterogeneous medium all strategies weight paths to infinity alike: with inconsistent weights a bidirectional path tracer,
// which combines the strategies, was a third too dark.
TEST(Surroundings, BothEndsOfPathsAgree) {
  struct Case {
    const char *objects, *camera;
    std::vector<const char*> renderers;
  };
  const std::vector<Case> cases = {
      {"Sphere { radius: 1, shader: Lambertian { color: 0.8 } }\nDistant { direction: [0, 1, -1], emission: DiffuseEmission { "
       "radiance: 1 } }\nSurroundings { reach: 2, interior: HomogeneousVolume { extinction: 0.1, albedo: 0.8 } }\n",
       "PerspectiveCamera { from: [0, -12, 0.5], to: [0, 0, 0], up: [0, 0, 1], fov: 20 }",
       {"PathTracer", "BidirectionalPathTracer", "LightTracer"}},
      {"Sphere { radius: 1, shader: Lambertian { color: 0.8 } }\nEnvironment { emission: DiffuseEmission { radiance: 1 } }\n"
       "Surroundings { reach: 4, interior: GridVolume { resolution: [2, 1, 1], density: [0.6, 1.4], extinction: 0.3, albedo: "
       "0.8, placement: scale(4) } }\n",
       "PerspectiveCamera { from: [0, -3, 0.5], to: [0, 0, 0], up: [0, 0, 1], fov: 40 }",
       {"PathTracer", "BidirectionalPathTracer"}}};
  for (const Case& c : cases) {
    std::vector<Measured> found;
    for (const char* renderer : c.renderers)
      found.push_back(measure(job_text(fmt::format("{} {{ max_depth: 3, samples: 4096 }}", renderer), c.camera, 4, c.objects)));
    for (size_t i = 1; i < found.size(); ++i)
      EXPECT_NEAR(found[i].mean.y, found[0].mean.y, 4.5 * std::hypot(found[i].error, found[0].error) + 1e-3 * found[0].mean.y)
          << c.renderers[i];
  }
}

// An unbounded emissive medium has the radiance emission / absorption in all directions.
TEST(Surroundings, EndlessLightIsEmissionOverAbsorption) {
  const Measured m =
      measure(job_text("PathTracer { samples: 64 }", "PerspectiveCamera { from: [0, -3, 0], to: [0, 0, 0], up: [0, 0, 1] }", 4,
                       "Sphere { centre: [0, 3, 0], radius: 0.1 }\n"
                       "Surroundings { interior: HomogeneousVolume { absorption: 0.5, emission: 0.75 } }"));
  EXPECT_NEAR(m.mean.y, 1.5, 4.5 * m.error + 2e-3);
}

// In water, a ball with the index of water is invisible; and whatever its priority, a body displaces the surroundings.
TEST(Surroundings, TheIndexOutsideOfABodyIsTheirs) {
  const auto seen = [](const std::string& ball) {
    return measure(job_text("PathTracer { samples: 512, max_depth: 8 }",
                            "PerspectiveCamera { from: [0, -3, 0], to: [0, 0, 0], up: [0, 0, 1], fov: 30 }", 4,
                            "Surroundings { shader: Dielectric { ior: 1.33 } }\n" + ball +
                                "Rectangle { corner: [-0.4, 4, -0.4], edge_u: [0, 0, 0.8], edge_v: [0.8, 0, 0], emission: "
                                "DiffuseEmission { radiance: 1, sides: both } }"));
  };
  const Measured without = seen(""), with = seen("Sphere { radius: 1, priority: -7, shader: Dielectric { ior: 1.33 } }\n"),
                 glass = seen("Sphere { radius: 1, priority: -7, shader: Dielectric { ior: 1.5 } }\n");
  EXPECT_NEAR(with.mean.y, without.mean.y, 4.5 * std::hypot(with.error, without.error));
  EXPECT_GT(std::abs(glass.mean.y - without.mean.y), 10 * std::hypot(glass.error, without.error));
}

TEST(Surroundings, WhatHasNoEndMustBeBearable) {
  expect_refused("Surroundings { interior: GridVolume { density: [1] } }", "interior", "give a reach");
  expect_refused("Surroundings { interior: HomogeneousVolume { emission: 1 } }", "interior", "endlessly bright");
  expect_refused("Surroundings { reach: 0.5 }", "reach", "before the scene");
  expect_refused("Surroundings { emission: DiffuseEmission { radiance: 1 } }", "emission", "no surface");
  for (const auto& [scene, words] :
       {std::pair("BvhScene { objects: [Surroundings { }, Surroundings { }] }", "surroundings already"),
        {"BvhScene { objects: [BvhScene { objects: [Surroundings { }] }] }", "nested scene"}}) {
    const Ref<Component> made = parse_component(scene, "test.etd");
    try {
      prepare_tree(*made);
      ADD_FAILURE() << "accepted: " << scene;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace etendue::test
