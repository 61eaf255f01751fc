// Metropolis renderers: the brightness as a whole and by path length, also of crops; the same bits for any number of threads;
// the first states of chains; refusals.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "etendue/transport/metropolis.h"
#include "support/checkpoint_test_support.h"
#include "support/image_means.h"

namespace etendue::checkpoint_test {
namespace {

// The inside of a sphere emits radiance 1 everywhere and reflects half of it: paths of n segments contribute 1 / 2^(n-1), 2 in
// all. Without next event estimation, and with roulette that ends walks after each segment with the probability 1/2, a walk
// contributes its number of segments: states differ in brightness, and chains must weight them.
std::string furnace_text(const std::string& renderer, const std::string& image) {
  return fmt::format(R"(Job {{ renderer: {}
    camera: PerspectiveCamera {{ from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }}
    image: ImageBuffer {{ width: 8, height: 8, filter: BoxFilter {{}}, {} }}
    scene: BruteForceScene {{ objects: [
      Sphere {{ shader: Lambertian {{ color: 0.5 }}, emission: DiffuseEmission {{ radiance: 1, sides: back }} }} ] }} }})",
                     renderer, image);
}
const std::string roulette = "PathTracer { next_event: false, roulette_depth: 1, max_depth: 60 }";

using test::means;

// Ten seeds: to 0.3 % of all light. Brightness is estimated from 1.3 10^6 walks in all, whose values have the relative standard
// deviation 0.7 (inner), from 2.6 10^6 single strategies (about 3), or from 1.3 10^5 pairs of walks (less than 1); except for
// `inner` only for a quarter of the light. With single strategies for all light the tolerance is 1 %.
struct MeansCase {
  const char *name, *renderer;
  double tolerance;
};
void PrintTo(const MeansCase& c, std::ostream* out) { *out << c.name; }

class MetropolisMeans : public ::testing::TestWithParam<MeansCase> {};

TEST_P(MetropolisMeans, AreRight) {
  const double tolerance = GetParam().tolerance;
  const std::string renderer = fmt::format(fmt::runtime(GetParam().renderer), fmt::arg("inner", roulette));
  std::map<std::string, double> mean;
  Render render(job_of(furnace_text(renderer, "path_lengths: 4"), 2048), two_threads);
  for (int seed = 0; seed < 10; ++seed) {
    test::render_again(render, std::uint64_t(seed));
    EXPECT_EQ(render.film().bad_samples(), 0u);
    for (const auto& [channel, value] : means(render.picture())) mean[channel] += value / 10;
  }
  EXPECT_NEAR(mean["Y"], 2, 2 * tolerance);
  EXPECT_NEAR(mean["length_1.Y"], 1, 2 * tolerance);
  EXPECT_NEAR(mean["length_2.Y"], 0.5, 2 * tolerance);
  EXPECT_NEAR(mean["length_3.Y"], 0.25, 2 * tolerance);
  EXPECT_NEAR(mean["length_4.Y"], 0.25, 2 * tolerance);  // and all longer ones
}

INSTANTIATE_TEST_SUITE_P(
    Metropolis, MetropolisMeans,
    ::testing::Values(
        MeansCase{"all_by_chains", "PrimarySampleMetropolis {{ inner: {inner}, direct: false, bootstrap: 1 }}", 0.003},
        MeansCase{"few_large_steps",
                  "PrimarySampleMetropolis {{ inner: {inner}, bootstrap: 1, even_errors: false, large_steps: 0.05 }}", 0.003},
        MeansCase{"multiplexed", "MultiplexedMetropolis {{ bootstrap: 1, mutations_per_sample: 2 }}", 0.003},
        MeansCase{"multiplexed_all_by_chains",
                  "MultiplexedMetropolis {{ bootstrap: 1, mutations_per_sample: 2, direct: false }}", 0.01},
        MeansCase{"path_space", "PathSpaceMetropolis {{ bootstrap: 0.1, mutations_per_sample: 1 }}", 0.003}),
    [](const auto& each) { return std::string(each.param.name); });

TEST(Metropolis, CropsAreAsBrightAsTheWholePicture) {
  for (const char* direct : {"true", "false"}) {
    const std::string renderer = fmt::format("PrimarySampleMetropolis {{ inner: {}, direct: {} }}", roulette, direct);
    const auto render = rendered(job_of(furnace_text(renderer, "crop: [2, 1, 6, 3]"), 16384), two_threads);
    EXPECT_NEAR(means(render->picture())["Y"], 2, 0.05);
  }
  // Light subpaths splat outside of a crop, too.
  const std::string renderer = "PrimarySampleMetropolis { inner: LightTracer { max_depth: 2 }, direct: false, bootstrap: 1 }";
  const std::string plane = R"(Job {{ renderer: {}
    camera: PerspectiveCamera {{ from: [0, 0, 2], to: [0, 0, 0], fov: 40 }}
    image: ImageBuffer {{ width: 8, height: 8, filter: BoxFilter {{}}, {} }}
    scene: BruteForceScene {{ objects: [
      Rectangle {{ corner: [-1, -1, 0], edge_u: [2, 0, 0], edge_v: [0, 2, 0], shader: Lambertian {{ color: 0.5 }} }}
      Distant {{ direction: [0, 0, -1], emission: DiffuseEmission {{ radiance: 3.14159265 }} }} ] }} }})";
  for (const char* crop : {"", "crop: [2, 1, 6, 3]"}) {
    const auto render = rendered(job_of(fmt::format(fmt::runtime(plane), renderer, crop), 16384), two_threads);
    EXPECT_NEAR(means(render->picture())["Y"], 0.5, 0.03) << crop;
  }
}

TEST(Metropolis, TheSameBitsForAnyNumberOfThreads) {
  for (const char* renderer : {"PrimarySampleMetropolis {}", "MultiplexedMetropolis {}", "PathSpaceMetropolis {}"}) {
    const auto bits = [&](int threads) { return film(*rendered(job_of(ball_text(renderer), 2000), {.threads = threads})); };
    EXPECT_TRUE(bits(1) == bits(3)) << renderer;
  }
}

// Each path starts its share of the chains, in proportion to its brightness, for any number of chains.
TEST(ChainStarts, AreInProportionToBrightness) {
  const ChainStarts starts({{7, 1, 0}, {8, 0, 1}, {9, 2, 2}, {10, 5, 1}});
  EXPECT_EQ(starts.mean(), 2);
  std::map<std::uint64_t, double> begun;
  const int repeats = 1000, chains = 3;
  for (int i = 0; i < repeats; ++i)
    for (std::uint64_t chain = 0; chain < chains; ++chain) begun[starts.begin(chain, chains, (i + 0.5) / repeats)] += 1;
  EXPECT_EQ(begun.size(), 3u);
  EXPECT_NEAR(begun[7] / (repeats * chains), 1 / 8.0, 1e-3);
  EXPECT_NEAR(begun[9] / (repeats * chains), 2 / 8.0, 1e-3);
  EXPECT_NEAR(begun[10] / (repeats * chains), 5 / 8.0, 1e-3);
}

// Each mutation alone, with few independent paths: the image of the chains agrees with that of another renderer in each of 4 x
// 3 pixels and by path length. A pdf that is wrong by a cosine or a squared distance moves light between the pixels by much
// more than the noise.
class Mutations : public ::testing::TestWithParam<const char*> {
 protected:
  static Image parts(const std::string& renderer, const std::string& scene, int samples) {
    const std::string text = "Job { renderer: " + renderer + R"(
      camera: PerspectiveCamera { from: [0, -3, 1], to: [0, 0, 0.6], up: [0, 0, 1], fov: 50 }
      image: ImageBuffer { width: 4, height: 3, filter: BoxFilter {}, path_lengths: 4 }
      scene: BruteForceScene { objects: [ )" +
                             scene + " ] } }";
    const auto render = rendered(job_of(text, samples), two_threads);
    EXPECT_EQ(render->film().bad_samples(), 0u);
    return render->picture();
  }
  /// Expects that pixels agree to within `tolerance` times the sum of their value and the mean.
  static void same(const Image& image, const Image& expected, const char* length, double tolerance) {
    const size_t y = size_t(std::ranges::find(image.channels, length) - image.channels.begin());
    double mean = 0;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i) mean += expected.at(i, j, y) / 12;
    EXPECT_GT(mean, 0);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(image.at(i, j, y), expected.at(i, j, y), tolerance * (mean + expected.at(i, j, y)))
            << length << " of " << i << ", " << j;
  }
  static std::string alone(const char* mutation, int max_depth) {
    return fmt::format(
        "PathSpaceMetropolis {{ max_depth: {}, large_steps: 0.1, even_errors: false, bootstrap: 0.1, chains: 64, "
        "mutations: [ {} {{}} ] }}",
        max_depth, mutation);
  }
};

// Two diffuse rectangles and a lamp.
TEST_P(Mutations, LeaveTheLightWhereItIs) {
  const std::string scene = R"(
        Rectangle { corner: [-1, -1, 0], edge_u: [2, 0, 0], edge_v: [0, 2, 0], shader: Lambertian { color: 0.8 } }
        Rectangle { corner: [-1, 1, 0], edge_u: [2, 0, 0], edge_v: [0, 0, 2], shader: Lambertian { color: 0.8 } }
        Rectangle { corner: [0.2, -0.6, 1.5], edge_u: [0, 0.8, 0], edge_v: [0.8, 0, 0.2], emission: DiffuseEmission { radiance: 5 } })";
  same(parts(alone(GetParam(), 4), scene, 65536), parts("PathTracer { max_depth: 4 }", scene, 65536), "length_3.Y", 0.08);
}

// A diffuse floor below a wide lamp, seen in a convex mirror and through a glass ball, both of which cast caustics: paths of
// three and four segments are the caustics of the mirror and of the glass, and the floor seen in the one and through the other.
TEST_P(Mutations, GoThroughMirrorsAndGlass) {
  const std::string scene = R"(
        Rectangle { corner: [-2, -2, 0], edge_u: [4, 0, 0], edge_v: [0, 4, 0], shader: Lambertian { color: 0.8 } }
        Sphere { centre: [0.6, 0.8, 0.9], radius: 0.8, shader: PerfectSpecular { color: 0.8 } }
        Sphere { centre: [-0.6, 0, 0.7], radius: 0.6, shader: Dielectric { ior: 1.5 } }
        Rectangle { corner: [-1, -1, 2.5], edge_u: [0, 2, 0], edge_v: [2, 0, 0], emission: DiffuseEmission { radiance: 5 } })";
  const Image image = parts(alone(GetParam(), 4), scene, 65536),
              expected = parts("BidirectionalPathTracer { max_depth: 4 }", scene, 65536);
  same(image, expected, "length_3.Y", 0.15);
  same(image, expected, "length_4.Y", 0.15);
}

INSTANTIATE_TEST_SUITE_P(PathSpace, Mutations,
                         ::testing::Values("BidirectionalMutation", "LensMutation", "CausticMutation", "MultiChainMutation",
                                           "ManifoldMutation"));

// A ball within rough glass of a higher priority is hidden, so the image is the same without it. Light subpaths pass the glass
// against the order in which the vertices of a path are stored.
TEST(Metropolis, PathsThroughRoughGlassKnowTheirMedia) {
  const auto light = [](const std::string& inner) {
    return means(test::rendered(job_of(R"(Job { renderer: PathSpaceMetropolis { max_depth: 3, large_steps: 1 }
      camera: PerspectiveCamera { from: [0, 0, -5], to: [0, 0, 0], fov: 26 }
      image: ImageBuffer { width: 8, height: 8 }
      scene: BvhScene { objects: [
        Sphere { radius: 1, priority: 1, shader: Dielectric { ior: 1.5, roughness: 0.4 } }
        Sphere { centre: [0, 3, 3], radius: 1, emission: DiffuseEmission { radiance: 20 } }
        )" + inner + " ] } }",
                                       1024),
                                two_threads)
                     ->picture())["Y"];
  };
  const double alone = light("");
  EXPECT_NEAR(light("Sphere { radius: 0.6, shader: Dielectric { ior: 2.5, roughness: 0.4 } }"), alone, 0.01 * alone);
}

// Media and null scattering are no part of path space. Walks ignore media and end at all surfaces, and so must connections: if
// only some ways make a path, its pdf is wrong.
TEST(Metropolis, ConnectionsPassWhatWalksPass) {
  const auto longer = [](const std::string& objects) {
    const Image image =
        test::rendered(job_of(R"(Job { renderer: PathSpaceMetropolis { max_depth: 3, large_steps: 1, bootstrap: 0.1 }
      camera: PerspectiveCamera { from: [0, -3, 1], to: [0, 0, 0.3], up: [0, 0, 1], fov: 50 }
      image: ImageBuffer { width: 8, height: 8, path_lengths: 3 }
      scene: BvhScene { objects: [ )" +
                                  objects + " ] } }",
                              1024),
                       two_threads)
            ->picture();
    return means(image)["length_3.Y"];
  };
  // A lamp behind a pane, which lights two walls through it.
  const auto behind = [&](const std::string& pane) {
    return longer(
        "Rectangle { corner: [-1, -1, 0], edge_u: [2, 0, 0], edge_v: [0, 2, 0], shader: Lambertian { color: 0.8 } },"
        "Rectangle { corner: [-1, 1, 0], edge_u: [2, 0, 0], edge_v: [0, 0, 2], shader: Lambertian { color: 0.8 } },"
        "Rectangle { corner: [-0.5, -0.5, 2], edge_u: [1, 0, 0], edge_v: [0, 1, 0],"
        "            emission: DiffuseEmission { radiance: 10, sides: both } },"
        "Rectangle { corner: [-1, -1, 1.5], edge_u: [2, 0, 0], edge_v: [0, 2, 0], shader: " +
        pane + " }");
  };
  EXPECT_EQ(behind("Lambertian { color: 0 }"), 0);
  EXPECT_EQ(behind("PassThrough {}"), 0);
  // A medium through which nothing is seen changes nothing.
  const auto glass = [&](const std::string& interior) {
    return longer("Sphere { centre: [0, 0, 0.3], priority: 1, shader: Dielectric { ior: 1.5, roughness: 0.4 }" + interior +
                  " }, Sphere { centre: [0, 3, 3], emission: DiffuseEmission { radiance: 20 } }");
  };
  const double clear = glass("");
  EXPECT_GT(clear, 0);
  EXPECT_EQ(glass(", interior: HomogeneousVolume { absorption: 10000 }"), clear);
}

TEST(Metropolis, RefusesWhatItCannotMutate) {
  const auto refused = [](const std::string& renderer, const std::string& more = "") {
    return complaint([&] { rendered(job_of(ball_text(renderer, "width: 2", "0.5", more), 16), two_threads); });
  };
  EXPECT_TRUE(
      has(refused("PrimarySampleMetropolis {}", "wavelengths: GridWavelengths {}\n"), "GridWavelengths cannot be mutated"));
  EXPECT_TRUE(has(refused("PrimarySampleMetropolis { inner: PrimarySampleMetropolis {} }"), "no paths that could be mutated"));
  EXPECT_EQ(refused("PrimarySampleMetropolis {}"), "");
  // Members that would have no effect.
  EXPECT_TRUE(has(refused("PrimarySampleMetropolis { inner: PathTracer { samples: 9 } }"),
                  "set it on the enclosing PrimarySampleMetropolis"));
  EXPECT_TRUE(
      has(refused("PrimarySampleMetropolis { inner: PathTracer { sampler: IndependentSampler {} } }"), "has no effect"));
  EXPECT_TRUE(has(refused("PrimarySampleMetropolis { light_sampler: PowerLightSampler {} }"), "inner.light_sampler"));
  EXPECT_TRUE(has(refused("PathSpaceMetropolis { mutations: [] }"), "there must be some"));
}

}  // namespace
}  // namespace etendue::checkpoint_test
