// Light groups: each has all the light of its luminaires, compared with a closed form for every renderer; their sum is the
// image; and a renderer that cannot separate them refuses.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "etendue/describe/reflection.h"
#include "etendue/film/image_tools.h"
#include "support/checkpoint_test_support.h"
#include "support/image_means.h"

namespace etendue::checkpoint_test {
namespace {

// The inside of a unit sphere emits the radiance 1 and reflects half of the light: 2 is seen everywhere. A point light of the
// intensity pi in its centre gives the irradiance pi everywhere, which is reflected as the radiance 1/2, and with all further
// reflections 1.
std::string room(const std::string& renderer, const std::string& layers) {
  return fmt::format(R"(bulb = DiffuseEmission {{ radiance: {} }}
    wall = Sphere {{ shader: Lambertian {{ color: 0.5 }}, emission: DiffuseEmission {{ radiance: 1, sides: back }} }}
    Job {{ renderer: {}
      camera: PerspectiveCamera {{ from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }}
      image: ImageBuffer {{ width: 8, height: 8, {} }}
      scene: BruteForceScene {{ objects: [ wall, Point {{ emission: bulb }} ] }} }})",
                     M_PI, renderer, layers);
}

using test::means;

/// Expects that the groups of each pixel add up to its value.
void expect_whole(const Image& image) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (size_t i = 3; i < image.channels.size(); ++i)
          if (image.channels[i].starts_with("light.") && image.channels[i].back() == image.channels[c].back())
            sum += image.at(x, y, i);
        EXPECT_NEAR(sum, image.at(x, y, c), 1e-5 * (1 + std::abs(image.at(x, y, c))))
            << x << ' ' << y << ' ' << image.channels[c];
      }
}

struct GroupCase {
  const char *name, *renderer;
  double wall, bulb;  ///< radiance that the renderer finds, of 2 and 1
  int samples;
  double tolerance = 0.02;
};
void PrintTo(const GroupCase& c, std::ostream* out) { *out << c.name; }

class LightGroupsOf : public ::testing::TestWithParam<GroupCase> {};

// Some 64 x samples paths; the standard errors are at most a quarter of the tolerance.
TEST_P(LightGroupsOf, HaveTheLightOfTheirLuminaires) {
  const GroupCase& c = GetParam();
  const auto render =
      test::rendered(job_of(room(c.renderer, R"(layers: ["light.wall", "light.bulb"])"), c.samples), two_threads);
  EXPECT_EQ(render->film().bad_samples(), 0u);
  const Image image = render->picture();
  std::map<std::string, double> mean = means(image);
  EXPECT_NEAR(mean["light.wall.Y"], c.wall, c.tolerance * c.wall);
  EXPECT_NEAR(mean["light.bulb.Y"], c.bulb, c.tolerance * c.bulb);
  EXPECT_EQ(mean["light.rest.Y"], 0);
  expect_whole(image);
}

INSTANTIATE_TEST_SUITE_P(
    All, LightGroupsOf,
    ::testing::Values(GroupCase{"path", "PathTracer {}", 2, 1, 256},
                      GroupCase{"path_without_sampling", "PathTracer { next_event: false }", 2, 0, 256},
                      GroupCase{"guided", "GuidedPathTracer {}", 2, 1, 256},
                      GroupCase{"adaptive", "AdaptiveSampling { inner: PathTracer {} }", 2, 1, 256},
                      GroupCase{"bidirectional", "BidirectionalPathTracer {}", 2, 1, 128},
                      GroupCase{"light", "LightTracer {}", 2, 1, 2048},
                      GroupCase{"merging", "VertexConnectionMerging { photon_walks: 2000 }", 2, 1, 64},
                      GroupCase{"photon_map", "PhotonMapper { photon_walks: 20000 }", 2, 1, 64, 0.05},
                      GroupCase{"photon_map_seen", "PhotonMapper { photon_walks: 20000, final_gather: false }", 2, 1, 64, 0.05},
                      GroupCase{"progressive", "ProgressivePhotonMapper { photon_walks: 20000 }", 2, 1, 64, 0.05},
                      GroupCase{"instant_radiosity", "InstantRadiosity {}", 2, 1, 128, 0.04},
                      GroupCase{"many_lights", "ManyLights { walks: 200 }", 2, 1, 64, 0.04},
                      GroupCase{"primary_sample_metropolis", "PrimarySampleMetropolis {}", 2, 1, 256, 0.04},
                      GroupCase{"multiplexed_metropolis", "MultiplexedMetropolis {}", 2, 1, 256, 0.04},
                      GroupCase{"distribution", "DistributionRenderer {}", 2, 1, 64},
                      GroupCase{"direct", "DirectRenderer {}", 1.5, 0.5, 256},
                      GroupCase{"whitted", "WhittedRenderer {}", 1, 0.5, 16}),
    [](const auto& info) { return info.param.name; });

// In fog, with photons gathered in all three ways: the groups of two lamps are in the proportion of the lamps' powers.
TEST(LightGroups, AreOfPhotonsInMedia) {
  for (const char* media : {"points", "along_rays", "beams"}) {
    const auto render = test::rendered(job_of(fmt::format(R"(bulb = DiffuseEmission {{ radiance: 3 }}
          lamp = DiffuseEmission {{ radiance: 1 }}
          Job {{ renderer: ProgressivePhotonMapper {{ media: {}, photon_walks: 4000 }}
            camera: PerspectiveCamera {{ from: [0, 0, 0], to: [0, 0, 1], fov: 60 }}
            image: ImageBuffer {{ width: 6, height: 6, layers: ["light.bulb", "light.lamp"] }}
            scene: BruteForceScene {{ objects: [
              Sphere {{ radius: 2, shader: PassThrough {{}}, interior: HomogeneousVolume {{ scattering: 0.5, absorption: 0.1 }} }}
              Point {{ position: [0, 1, 1], emission: bulb }}, Point {{ position: [0, -1, 1], emission: lamp }} ] }} }})",
                                                          media),
                                              128),
                                       two_threads);
    expect_whole(render->picture());
    std::map<std::string, double> mean = means(render->picture());
    EXPECT_NEAR(mean["light.bulb.Y"], 3 * mean["light.lamp.Y"], 0.1 * mean["light.bulb.Y"]) << media;
    EXPECT_EQ(mean["light.rest.Y"], 0) << media;
  }
}

// Light of unnamed luminaires is in the rest; several names make one group; a luminaire belongs to a group by its own name or
// by that of its emission.
TEST(LightGroups, AreOfNames) {
  const auto found = [](const std::string& layers) {
    return means(test::rendered(job_of(room("PathTracer {}", layers), 64), two_threads)->picture());
  };
  auto one = found(R"(layers: ["light.bulb", "depth"], path_lengths: 2)");
  EXPECT_NEAR(one["light.bulb.Y"], 1, 0.03);
  EXPECT_NEAR(one["light.rest.Y"], 2, 0.06);
  EXPECT_NEAR(one["length_1.Y"], 1, 0.01);
  EXPECT_NEAR(one["length_2.Y"], 2, 0.06);
  auto both = found(R"(layers: ["light.wall + bulb"])");
  EXPECT_NEAR(both["light.wall + bulb.Y"], 3, 0.09);
  EXPECT_EQ(both["light.rest.Y"], 0);
}

// With a crop, a wide filter, different numbers of samples and splats, the groups are filtered as the whole image is.
TEST(LightGroups, AreWholeOfCropsAndFilters) {
  for (const char* renderer :
       {"PathTracer {}", "BidirectionalPathTracer {}", "LightTracer {}", "AdaptiveSampling { inner: PathTracer {} }"}) {
    const auto render = test::rendered(
        job_of(room(renderer, R"(filter: MitchellFilter {}, crop: [2, 1, 7, 6], layers: ["light.wall"])"), 16), two_threads);
    expect_whole(render->picture());
  }
}

/// The message of the error that rendering the job throws; empty: none.
std::string refused(const std::string& renderer, const std::string& layers) {
  try {
    Render(job_of(room(renderer, layers), 16), two_threads).run();
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}

TEST(LightGroups, RefuseWhatTheyCannotTell) {
  const std::string wall = R"(layers: ["light.wall"])";
  EXPECT_EQ(refused("PathTracer {}", wall), "");
  EXPECT_TRUE(has(refused("PathTracer {}", R"(layers: ["light.wal"])"), "did you mean 'wall'"));
  EXPECT_TRUE(has(refused("PathTracer {}", R"(layers: ["light.wall+lamp"])"), "is called 'lamp'"));
  EXPECT_TRUE(has(refused("PathTracer {}", R"(layers: ["light."])"), "needs the name"));
  EXPECT_TRUE(has(refused("PathTracer {}", R"(layers: ["light.rest"])"), "by itself"));
  EXPECT_TRUE(has(refused("PhotonMapper { irradiance: true, photon_walks: 20000, farthest: 2 }", wall),
                  "does not tell which luminaires"));
  EXPECT_TRUE(has(refused("FeatureRenderer { feature: albedo }", wall), "does not tell which luminaires"));
}

// Any name may follow "light.", and other unknown layers are refused.
TEST(LightGroups, AreAnOpenChoice) {
  EXPECT_TRUE(has(refused("PathTracer {}", R"(layers: ["albdo"])"), "did you mean 'albedo'"));
  EXPECT_TRUE(has(refused("PathTracer {}", R"(layers: ["lights.wall"])"), "no choice 'lights.wall'"));
  EXPECT_TRUE(has(json_schema(), R"("pattern": "^light\\.")"));
}

// A film's state is not loaded into a film with other groups.
TEST(LightGroups, BelongToTheState) {
  const auto with = [](const std::string& layers) {
    return test::rendered(job_of(room("PathTracer {}", layers), 2), two_threads);
  };
  const std::vector<std::byte> of_wall = with(R"(layers: ["light.wall"])")->film().save_state();
  const auto again = with(R"(layers: ["light.wall"])"), other = with(R"(layers: ["light.bulb"])");
  Film film(*again->job().image);
  film.load_state(of_wall);
  EXPECT_EQ(film.develop().values, again->picture().values);
  Film of_bulb(*other->job().image);
  EXPECT_THROW(of_bulb.load_state(of_wall), Error);
}

// In a file, groups are in the colour space of the image.
TEST(LightGroups, AreInExrFiles) {
  const Image picture = test::rendered(job_of(room("PathTracer {}", R"(layers: ["light.wall"])"), 4), two_threads)->picture();
  const std::string file = (std::filesystem::temp_directory_path() / "etendue_light_groups.exr").string();
  write_any(picture, file);
  const Image read = read_image(file);
  std::filesystem::remove(file);
  for (const char* name : {"R", "light.wall.R", "light.wall.B", "light.rest.G"})
    EXPECT_NE(std::ranges::find(read.channels, name), read.channels.end()) << name;
  std::map<std::string, double> mean = means(read);
  for (const std::string c : {"R", "G", "B"})
    EXPECT_NEAR(mean["light.wall." + c] + mean["light.rest." + c], mean[c], 1e-5 * mean[c]);
}

}  // namespace
}  // namespace etendue::checkpoint_test
