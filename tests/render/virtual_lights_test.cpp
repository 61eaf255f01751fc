// Virtual lights: all light is found, by path length, for any bound of the geometry term; the light that remains without
// compensation; the same bits for any number of threads; one light of each group represents the group without bias.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "components/renderers/virtual_light_tree.h"
#include "etendue/transport/metropolis.h"
#include "etendue/transport/primary_sample_vectors.h"
#include "support/checkpoint_test_support.h"

namespace etendue::checkpoint_test {
namespace {

// The inside of a sphere emits radiance 1 everywhere and reflects half of it: paths of n segments contribute 1 / 2^(n-1).
// Between any two points of a sphere of radius R the geometry term is 1 / (4 R^2), so virtual lights contribute the same
// fraction w everywhere: all where `nearest` is small, and nothing where it is large.
struct Case {
  const char *name, *renderer;
  double all;     ///< radiance of paths of all lengths
  double longer;  ///< radiance of paths of more than two segments, over 0.5
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class VirtualLightsInASphere : public ::testing::TestWithParam<Case> {};

TEST_P(VirtualLightsInASphere, FindAllLight) {
  const auto render = rendered(job_of(fmt::format(R"(Job {{ renderer: {}
    camera: PerspectiveCamera {{ from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }}
    image: ImageBuffer {{ width: 8, height: 8, filter: BoxFilter {{}}, path_lengths: 4 }}
    scene: BruteForceScene {{ objects: [
      Sphere {{ shader: Lambertian {{ color: 0.5 }}, emission: DiffuseEmission {{ radiance: 1, sides: back }} }} ] }} }})",
                                                  GetParam().renderer),
                                      400),
                               two_threads);
  EXPECT_EQ(render->film().bad_samples(), 0u);
  const Image image = render->picture();
  const auto mean = [&](const char* channel) {
    const size_t c = size_t(std::ranges::find(image.channels, channel) - image.channels.begin());
    double sum = 0;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) sum += image.at(x, y, c) / 64;
    return sum;
  };
  // 25,600 samples, with a different number of lights in each step: standard errors of half a per cent.
  EXPECT_NEAR(mean("Y"), GetParam().all, 0.03);
  EXPECT_NEAR(mean("length_1.Y"), 1, 0.02);
  EXPECT_NEAR(mean("length_2.Y"), 0.5, 0.01);
  EXPECT_NEAR(mean("length_3.Y"), 0.5 * GetParam().longer, 0.01);
  EXPECT_NEAR(mean("length_4.Y"), 0.5 * GetParam().longer, 0.02);  // and all longer ones
}

INSTANTIATE_TEST_SUITE_P(
    Both, VirtualLightsInASphere,
    ::testing::Values(Case{"instant_far", "InstantRadiosity { nearest: 0.001 }", 2, 0.5},
                      Case{"instant_middle", "InstantRadiosity { nearest: 10 }", 2, 0.5},
                      Case{"instant_near", "InstantRadiosity { nearest: 100000 }", 2, 0.5},
                      Case{"instant_far_alone", "InstantRadiosity { nearest: 0.001, compensate: false }", 2, 0.5},
                      Case{"instant_nothing", "InstantRadiosity { nearest: 100000, compensate: false }", 1.5, 0},
                      Case{"many_far", "ManyLights { nearest: 0.001, walks: 300, samples_per_tree: 1 }", 2, 0.5},
                      Case{"many_middle", "ManyLights { nearest: 10, walks: 300, cut: 1, samples_per_tree: 1 }", 2, 0.5},
                      Case{"many_nothing", "ManyLights { nearest: 100000, compensate: false, walks: 300 }", 1.5, 0}),
    [](const auto& each) { return std::string(each.param.name); });

// Radiance 1 arrives from all directions, and a ball of fog that absorbs nothing is invisible. Half of the light that leaves
// the ball towards the camera was scattered more than once.
TEST(VirtualLights, FogThatAbsorbsNothingIsNotSeen) {
  for (const char* renderer : {"InstantRadiosity { max_depth: 100, nearest: 1 }",
                               "ManyLights { max_depth: 100, nearest: 1, walks: 300, cut: 4, samples_per_tree: 1 }"}) {
    const auto render = rendered(job_of(fmt::format(R"(Job {{ renderer: {}
      camera: PerspectiveCamera {{ from: [0, 0, -3], to: [0, 0, 0], fov: 30 }}
      image: ImageBuffer {{ width: 4, height: 4, filter: BoxFilter {{}} }}
      scene: BruteForceScene {{ objects: [
        Sphere {{ shader: PassThrough {{}}, interior: HomogeneousVolume {{ scattering: 1.5, absorption: 0 }} }}
        Environment {{ emission: DiffuseEmission {{ radiance: 1 }} }} ] }} }})",
                                                    renderer),
                                        2000),
                                 two_threads);
    const Image image = render->picture();
    double mean = 0;
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) mean += image.at(x, y, 1) / 16;
    EXPECT_NEAR(mean, 1, 0.02) << renderer;  // 2000 steps with some lights each: the tolerance is four standard errors
    EXPECT_EQ(render->film().bad_samples(), 0u);
  }
}

TEST(VirtualLights, TheSameBitsForAnyNumberOfThreads) {
  for (const char* renderer : {"InstantRadiosity {}", "ManyLights { walks: 600 }"}) {
    const auto bits = [&](int threads) { return film(*rendered(job_of(ball_text(renderer), 8), {.threads = threads})); };
    EXPECT_TRUE(bits(1) == bits(3)) << renderer;
  }
}

// For any contributions of the lights in front of a point, the mean over sampled cuts is the sum over all lights.
TEST(VirtualLightTree, OneOfEachGroupStandsForAll) {
  ChoiceNumbers random(1);
  const auto next = [&] { return float(random.next()); };
  std::vector<VirtualLight> lights(300);
  for (VirtualLight& light : lights) {
    light.at.point.position = {4 * next() - 2, 4 * next() - 2, next() - 0.2f};
    light.at.throughput = Spectrum(0.1f + next() * next());
  }
  VirtualLightTree tree;
  tree.build(lights);
  const VirtualLightTree::Place place{{0.1f, 0.2f, 0}, {0, 0, 1}, 0.3f};
  const auto brought = [&](std::uint32_t i) {
    const Vector3 d = lights[i].at.point.position - place.position;
    if (d.z <= 0) return 0.0;
    return double(lights[i].at.throughput.average()) / std::max(double(length_squared(d)), 0.09) * (1 + std::sin(double(i)));
  };
  double all = 0;
  for (std::uint32_t i = 0; i < lights.size(); ++i) all += brought(i);
  const MutatedPrimarySamples source(7);
  for (const size_t nodes : {size_t(1), size_t(6), size_t(1000)}) {
    constexpr int repeats = 20000;
    double sum = 0, squares = 0;
    std::vector<VirtualLightTree::Sample> samples;
    for (int repeat = 0; repeat < repeats; ++repeat) {
      SampleKey key;
      key.walk = mix_bits(std::uint64_t(repeat));
      NumberStream numbers(source, key);
      tree.cut(place, nodes, numbers, samples);
      EXPECT_LE(samples.size(), std::min(nodes, lights.size()));
      double one = 0;
      for (const auto& [light, probability] : samples) one += brought(light) / probability;
      sum += one;
      squares += one * one;
    }
    const double mean = sum / repeats, error = std::sqrt(std::max(0.0, squares / repeats - mean * mean) / repeats);
    EXPECT_NEAR(mean, all, 4 * error + 1e-5 * all) << nodes;
    EXPECT_LT(error, 0.01 * all) << nodes;
  }
}

}  // namespace
}  // namespace etendue::checkpoint_test
