// Scenes that are each hard for some algorithm, in a small size for every day: all renderers that find their light agree. With
// the budgets of docs/results/agreement.md, which take minutes, an error of 1 % is found; here only one of a few per cent.

#include <gtest/gtest.h>

#include "support/process.h"

namespace etendue {
namespace {

struct VerifyScene {
  const char* name;
  int samples;
  std::string more;  ///< renderers beside PathTracer and BidirectionalPathTracer, with a comma before each
};
void PrintTo(const VerifyScene& s, std::ostream* out) { *out << s.name; }

class VerifyScenes : public ::testing::TestWithParam<VerifyScene> {
 protected:
  TemporaryFolder folder;
  int verify(const std::vector<std::string>& more, std::string* text = nullptr) {
    std::vector<std::string> arguments{
        "verify",    std::string(ETENDUE_SOURCE_DIR "/scenes/verify/") + GetParam().name + ".etd",
        "--size",    "64x48",
        "--samples", std::to_string(GetParam().samples)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Process process(ETENDUE_BINARY_DIR "/etendue", arguments, folder);
    const int status = process.wait();
    if (text) *text = process.out() + process.err();
    return status;
  }
};

TEST_P(VerifyScenes, RenderersAgree) {
  std::string text;
  EXPECT_EQ(verify({"--renderers", "PathTracer,BidirectionalPathTracer" + GetParam().more}, &text), 0) << text;
  EXPECT_NE(text.find("PathTracer and BidirectionalPathTracer"), std::string::npos) << text;
}

// The guide's pdfs enter the weights through both subpaths: if one lacks them, light is counted twice. In this scene the light
// subpath matters least: if the guide is missing in its pdfs alone, the image is 1 % too bright.
TEST(VerifyGuide, DensitiesStandInAllWeights) {
  TemporaryFolder folder;
  Process process(ETENDUE_BINARY_DIR "/etendue",
                  {"verify", ETENDUE_SOURCE_DIR "/scenes/verify/small_opening.etd", "--size", "32x24", "--samples", "3072",
                   "--renderers", "GuidedPathTracer,BidirectionalPathTracer{guided: true}"},
                  folder);
  EXPECT_EQ(process.wait(), 0) << process.out();
}

// BidirectionalPathTracer says that it loses the fluorescence of dyes in media.
TEST(VerifyFluorescence, DyesInMediaAreFoundFromBothEnds) {
  TemporaryFolder folder;
  Process process(ETENDUE_BINARY_DIR "/etendue",
                  {"verify", ETENDUE_SOURCE_DIR "/scenes/verify/fluorescent_water.etd", "--size", "32x24", "--samples", "1024",
                   "--renderers", "PathTracer,GuidedPathTracer,LightTracer"},
                  folder);
  EXPECT_EQ(process.wait(), 0) << process.out();
}

// Even so, a quarter of the light too much is found in every scene.
TEST_P(VerifyScenes, AnErrorIsNoticed) {
  EXPECT_EQ(verify({"--inject", "1.25", "--renderers", "PathTracer,BidirectionalPathTracer", "--quiet"}), 1);
}

// Each renderer is tested in some of the scenes it is made for, not in all, since chains and photons take long.
const std::string light = ",LightTracer", guided = ",GuidedPathTracer",
                  guided_both_ways = guided + ",BidirectionalPathTracer{guided: true}", distribution = ",DistributionRenderer",
                  photons = ",VertexConnectionMerging,ProgressivePhotonMapper",
                  virtual_lights = ",InstantRadiosity{walks: 4},ManyLights{cut: 2}",
                  chains = ",PrimarySampleMetropolis{inner: PathTracer {}},MultiplexedMetropolis,PathSpaceMetropolis";

INSTANTIATE_TEST_SUITE_P(
    Scenes, VerifyScenes,
    ::testing::Values(
        VerifyScene{"cornell_box", 256, light + guided + distribution + photons + chains + virtual_lights},
        VerifyScene{"glossy_box", 192, light + guided + distribution},
        VerifyScene{"fluorescent_box", 256, light + guided + ",SimplePathTracer,BidirectionalPathTracer{guided: true}"},
        VerifyScene{"caustic_through_glass", 512, photons}, VerifyScene{"door_ajar", 256, light},
        VerifyScene{"mis_plates", 256, light + distribution},
        VerifyScene{"fog_with_spot", 512, light + guided + ",MultiplexedMetropolis{mutations_per_sample: 1}"},
        VerifyScene{"nested_dielectrics", 512, guided_both_ways}, VerifyScene{"sphere_and_environment", 256, guided},
        VerifyScene{"every_rough_shader", 256, guided}, VerifyScene{"every_mirror_shader", 512, guided},
        VerifyScene{"every_emission", 256, light}, VerifyScene{"every_sky", 256, distribution},
        VerifyScene{"nested_lamps", 192, light}, VerifyScene{"small_opening", 256, light + guided_both_ways},
        VerifyScene{"tilted_normals", 512, distribution}, VerifyScene{"mirror_caustic", 256, photons + ",PathSpaceMetropolis"},
        VerifyScene{"sunlit_pool", 256, photons}, VerifyScene{"iced_water_in_fog", 256, photons}),
    [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace etendue
