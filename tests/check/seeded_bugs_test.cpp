// Ten faults of the kind that give plausible pictures, switched on one at a time in copies of the renderers: `verify` must
// find each, and nothing when none is on.

#include <gtest/gtest.h>

#include <cstdlib>

#include "support/process.h"

namespace etendue {
namespace {

const char* const verify_scenes = ETENDUE_SOURCE_DIR "/scenes/verify/";

// A lamp in a ball of glass and a floor around it: light leaves the glass once, and is not refracted back.
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
  const char* name;
  int bug;
  const char *scene, *renderer, *reference;
  int samples;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

/// The exit status of verify: 0 agreement, 1 disagreement.
int verify(const Case& c, bool with_bug) {
  TemporaryFolder folder;
  setenv("ETENDUE_SEEDED_BUG", with_bug ? std::to_string(c.bug).c_str() : "0", 1);
  const std::string scene = std::string(c.scene) == "lamp_in_glass" ? folder.write("lamp.etd", lamp_in_glass)
                                                                    : verify_scenes + std::string(c.scene) + ".etd";
  Process process(
      ETENDUE_BINARY_DIR "/etendue",
      {"verify", scene, "--plugin", ETENDUE_SEEDED_BUGS_LIBRARY, "--renderers", std::string(c.reference) + "," + c.renderer,
       "--samples", std::to_string(c.samples), "--size", "48x36", "--tile", "12"},
      folder);
  const int status = process.wait();
  unsetenv("ETENDUE_SEEDED_BUG");
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
    ::testing::Values(Case{"wrong_mis_weight", 1, "cornell_box", "SeededPathTracer", "PathTracer", 256},
                      Case{"no_squared_index", 2, "lamp_in_glass", "SeededPathTracer", "BidirectionalPathTracer", 128},
                      Case{"lost_cosine", 3, "cornell_box", "SeededBidirectionalPathTracer", "PathTracer", 128},
                      Case{"wrong_measure", 4, "cornell_box", "SeededBidirectionalPathTracer", "PathTracer", 128},
                      Case{"roulette_undivided", 5, "cornell_box", "SeededPathTracer", "LightTracer", 512},
                      Case{"luminaire_twice", 6, "cornell_box", "SeededPathTracer", "PathTracer", 256},
                      Case{"lens_importance", 7, "cornell_box", "SeededLightTracer", "BidirectionalPathTracer", 1024},
                      Case{"phase_density", 8, "fog_with_spot", "SeededPathTracer", "BidirectionalPathTracer", 256},
                      Case{"transmittance_squared", 9, "fog_with_spot", "SeededPathTracer", "BidirectionalPathTracer", 128},
                      Case{"skipped_length", 10, "cornell_box", "SeededBidirectionalPathTracer", "PathTracer", 256}),
    [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace etendue
