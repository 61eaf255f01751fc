// Faults of the kind that give plausible images, one at a time, in renderers built from the same parts as the program's
// (faulty_renderers): `verify` must find each, and find nothing without a fault.

#include <gtest/gtest.h>

#include <cstdlib>

#include "support/process.h"

namespace etendue {
namespace {

const char* const verify_scenes = ETENDUE_SOURCE_DIR "/scenes/verify/";

// A lamp in a glass ball and a floor outside: light leaves the glass once and is not refracted back.
const char* const lamp_in_glass = R"(Job {
  renderer: PathTracer { max_depth: 8 }
  camera: PerspectiveCamera { from: [0, 1, -6], to: [0, 0, 0], fov: 40 }
  image: ImageBuffer { width: 48, height: 36, filter: BoxFilter {} }
  scene: BruteForceScene { objects: [
    Sphere { radius: 1, shader: Dielectric { ior: 1.5 } }
    Sphere { radius: 0.6, shader: Lambertian { color: 0.5 }, emission: DiffuseEmission { radiance: 1 } }
    Rectangle { corner: [-5, -1, -5], edge_u: [0, 0, 10], edge_v: [10, 0, 0], shader: Lambertian { color: 0.5 } }
  ] }
})";

struct Case {
  const char *name, *scene, *renderer, *reference;
  int samples;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

/// The exit status of verify: 0 agreement, 1 disagreement.
int verify(const Case& c, bool with_bug) {
  TemporaryFolder folder;
  const std::string scene = std::string(c.scene) == "lamp_in_glass" ? folder.write("lamp.etd", lamp_in_glass)
                                                                    : verify_scenes + std::string(c.scene) + ".etd";
  Process process(
      ETENDUE_BINARY_DIR "/etendue",
      {"verify", scene, "--plugin", ETENDUE_FAULTY_RENDERERS, "--renderers",
       std::string(c.reference) + "," + c.renderer + (with_bug ? std::string(" { fault: \"") + c.name + "\" }" : ""),
       "--samples", std::to_string(c.samples), "--size", "48x36", "--tile", "12"},
      folder);
  const int status = process.wait();
  if (status != int(with_bug)) ADD_FAILURE() << process.out() << process.err();
  return status;
}

class SeededBugs : public ::testing::TestWithParam<Case> {};

TEST_P(SeededBugs, AreFound) {
  EXPECT_EQ(verify(GetParam(), true), 1);
  EXPECT_EQ(verify(GetParam(), false), 0) << "without the fault the renderers should agree";
}

INSTANTIATE_TEST_SUITE_P(
    Verify, SeededBugs,
    ::testing::Values(Case{"wrong_mis_weight", "cornell_box", "FaultyPathTracer", "PathTracer", 256},
                      Case{"no_squared_index", "lamp_in_glass", "FaultyPathTracer", "BidirectionalPathTracer", 128},
                      Case{"lost_cosine", "cornell_box", "FaultyPathTracer", "PathTracer", 128},
                      Case{"wrong_measure", "cornell_box", "FaultyPathTracer", "PathTracer", 128},
                      Case{"roulette_undivided", "cornell_box", "FaultyPathTracer", "LightTracer", 512},
                      Case{"luminaire_twice", "cornell_box", "FaultyPathTracer", "PathTracer", 256},
                      Case{"lens_importance", "cornell_box", "FaultyLightTracer", "BidirectionalPathTracer", 1024},
                      Case{"phase_density", "fog_with_spot", "FaultyPathTracer", "BidirectionalPathTracer", 256},
                      Case{"transmittance_squared", "fog_with_spot", "FaultyPathTracer", "BidirectionalPathTracer", 128},
                      Case{"skipped_length", "cornell_box", "FaultyPathTracer", "PathTracer", 256},
                      Case{"acceptance_inverted", "cornell_box", "FaultyMetropolis", "PathTracer", 256},
                      Case{"no_expected_values", "cornell_box", "FaultyMetropolis", "PathTracer", 256},
                      Case{"large_steps_twice", "cornell_box", "FaultyMetropolis", "PathTracer", 256},
                      Case{"direct_light_twice", "cornell_box", "FaultyMetropolis", "PathTracer", 256},
                      Case{"dark_paths_left_out", "cornell_box", "FaultyMetropolis", "PathTracer", 256},
                      Case{"guide_density", "cornell_box", "FaultyGuidedTracer", "PathTracer", 256},
                      Case{"merging_unweighted", "cornell_box", "FaultyMerger", "PathTracer", 256},
                      Case{"kernel_not_shrunk", "cornell_box", "FaultyMerger", "PathTracer", 256}),
    [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace etendue
