// Layers by light path expressions: those that divide all paths add up to the picture in every renderer, and renderers that
// find all light agree about each layer, whether they follow paths from the camera, from luminaires or from both, merge
// photons, or mutate paths.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "etendue/film/image_tools.h"
#include "support/checkpoint_test_support.h"
#include "support/image_means.h"

namespace etendue::checkpoint_test {
namespace {

using test::means;

/// These match each path once. Their last events may be any: luminaires, the background, or media that emit.
constexpr const char* division =
    R"("path.emitted = C[LBO]", "path.diffuse = C<.D>[LBO]", "path.glossy = C<.G>[LBO]", "path.specular = C<.S>[LBO]",
       "path.volume = CV[LBO]", "path.to_diffuse = C<.D>[RTV].*", "path.to_glossy = C<.G>[RTV].*", "path.to_specular = C<.S>[RTV].*",
       "path.to_volume = CV[RTV].*")";
constexpr const char* named =
    R"("path.caustics = C<RD>S+L", "path.ball = C'ball'.*", "path.bounce = C.<.D'plastic'>.*", "path.key = C.*<L.'key'>",
       "path.all = C.*[LBO]", "path.background = C.*B", "path.fog = C.*O")";

/// A room with a rough plastic ball, which is both diffuse and glossy, a glass ball, a lamp and a window.
std::string room(const std::string& renderer, const std::string& layers) {
  return fmt::format(R"(plastic = Plastic {{ color: rgb(0.7, 0.3, 0.2), roughness: 0.3 }}
    ball = Sphere {{ centre: [-0.5, -0.5, 0.4], radius: 0.5, shader: Dielectric {{}} }}
    key = DiffuseEmission {{ radiance: 5 }}
    Job {{ renderer: {}
      camera: PerspectiveCamera {{ from: [0, 0.3, 2.6], to: [0, 0, 0], fov: 60 }}
      image: ImageBuffer {{ width: 10, height: 8, layers: [{}] }}
      scene: BvhScene {{ objects: [
        Sphere {{ centre: [0.6, -0.5, 0.3], radius: 0.5, shader: plastic }}
        ball
        Rectangle {{ corner: [-4, -1, -4], edge_u: [0, 0, 8], edge_v: [8, 0, 0], shader: plastic }}
        Rectangle {{ corner: [-4, -1, -2], edge_u: [8, 0, 0], edge_v: [0, 4, 0], shader: Lambertian {{ color: 0.6 }} }}
        Sphere {{ centre: [0, 2, 0.5], radius: 0.5, shader: Lambertian {{ color: 0.2 }}, emission: key }}
        Environment {{ emission: EnvironmentEmission {{ radiance: 0.3 }} }} ] }} }})",
                     renderer, layers);
}

/// A fog around a plastic ball and a lamp.
std::string fog(const std::string& renderer, const std::string& layers, double emission) {
  return fmt::format(R"(plastic = Plastic {{ color: rgb(0.7, 0.3, 0.2), roughness: 0.3 }}
    ball = Sphere {{ radius: 0.5, shader: plastic }}
    key = DiffuseEmission {{ radiance: 5 }}
    Job {{ renderer: {}
      camera: PerspectiveCamera {{ from: [0, 0.3, 2.6], to: [0, 0, 0], fov: 60 }}
      image: ImageBuffer {{ width: 10, height: 8, layers: [{}] }}
      scene: BvhScene {{ objects: [
        ball
        Sphere {{ centre: [0, 2, 0.5], radius: 0.5, emission: key }}
        Sphere {{ radius: 4, shader: PassThrough {{}},
                  interior: HomogeneousVolume {{ scattering: 0.2, absorption: 0.05, emission: {} }} }} ] }} }})",
                     renderer, layers, emission);
}
std::string dark_fog(const std::string& renderer, const std::string& layers) { return fog(renderer, layers, 0); }
std::string glowing_fog(const std::string& renderer, const std::string& layers) { return fog(renderer, layers, 0.02); }

void expect_division(const Image& image, const std::string& what) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (size_t i = 0; i < 9; ++i) sum += image.at(x, y, 3 + 3 * i + c);
        ASSERT_NEAR(sum, image.at(x, y, c), 1e-5 * (1e-3 + std::abs(image.at(x, y, c)))) << what << ": " << x << ' ' << y;
      }
}

using SceneText = std::string (*)(const std::string& renderer, const std::string& layers);

struct LayerCase {
  const char *name, *renderer;
  int samples;
  bool finds_all = true;
  SceneText fog = glowing_fog;  ///< null: it finds no light in fog
  double bias = 0;
};
void PrintTo(const LayerCase& c, std::ostream* out) { *out << c.name; }
class PathLayersOf : public ::testing::TestWithParam<LayerCase> {};

/// The mean of each layer over the picture, and the variance of that mean, from renders with different seeds.
struct Estimate {
  double mean = 0, variance = 0;
};
constexpr int renders = 8;

std::map<std::string, Estimate> layers_of(SceneText scene, const char* renderer, int samples, int first_seed) {
  std::map<std::string, Estimate> found;
  for (int i = 0; i < renders; ++i) {
    const Ref<Job> job = job_of(scene(renderer, std::string(division) + ", " + named), samples);
    job->seed = std::uint64_t(first_seed + i);
    const auto render = test::rendered(job, two_threads);
    EXPECT_EQ(render->film().bad_samples(), 0u);
    const Image image = render->picture();
    expect_division(image, renderer);
    for (const auto& [channel, mean] : means(image)) {
      if (!channel.ends_with("Y")) continue;
      found[channel].mean += mean / renders;
      found[channel].variance += mean * mean / renders;
    }
  }
  for (auto& [channel, e] : found) e.variance = std::max(0.0, e.variance - e.mean * e.mean) / (renders - 1);
  EXPECT_NEAR(found["path.all.Y"].mean, found["Y"].mean, 1e-5 * found["Y"].mean);
  return found;
}

/// Compares each layer with that of path tracing. Both are means of 8 renders, so that their difference over its standard error
/// has a Student distribution of 7 to 14 degrees of freedom, by which 8 is exceeded with a probability below 1e-4. `bias`: of
/// algorithms that blur, relative.
void expect_agreement(SceneText scene, const LayerCase& c) {
  static std::map<SceneText, std::map<std::string, Estimate>> known;
  std::map<std::string, Estimate>& truth = known[scene];
  if (truth.empty()) truth = layers_of(scene, "PathTracer { max_depth: 6, roulette_depth: 6 }", 512, 100);
  std::map<std::string, Estimate> found = layers_of(scene, c.renderer, c.samples, 1);
  if (!c.finds_all) return;
  for (const auto& [layer, light] : truth)
    EXPECT_NEAR(found[layer].mean, light.mean,
                8 * std::sqrt(found[layer].variance + light.variance) + c.bias * light.mean + 1e-4 * truth["Y"].mean)
        << layer;
}

TEST_P(PathLayersOf, DivideTheLightOfARoom) { expect_agreement(room, GetParam()); }
TEST_P(PathLayersOf, DivideTheLightOfFog) {
  if (GetParam().fog) expect_agreement(GetParam().fog, GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    All, PathLayersOf,
    ::testing::Values(
        LayerCase{"path", "PathTracer { max_depth: 6 }", 32},
        LayerCase{"path_split", "PathTracer { max_depth: 6, split_depth: 3 }", 32},
        LayerCase{"path_by_chance", "PathTracer { max_depth: 6, next_event: false }", 64},
        LayerCase{"manifold", "ManifoldPathTracer { max_depth: 6 }", 32},
        LayerCase{"guided", "GuidedPathTracer { max_depth: 6 }", 32},
        LayerCase{"adaptive", "AdaptiveSampling { inner: PathTracer { max_depth: 6 } }", 32},
        LayerCase{"bidirectional", "BidirectionalPathTracer { max_depth: 6 }", 32},
        LayerCase{"light", "LightTracer { max_depth: 6 }", 32, false},
        LayerCase{"merging", "VertexConnectionMerging { max_depth: 6, photon_walks: 2000, radius: 0.3 }", 32, true, glowing_fog,
                  0.02},
        LayerCase{"photons", "ProgressivePhotonMapper { max_depth: 6, photon_walks: 4000, radius: 0.3 }", 32, true, dark_fog,
                  0.03},
        LayerCase{"photons_along_rays",
                  "ProgressivePhotonMapper { max_depth: 6, photon_walks: 4000, radius: 0.3, media: along_rays }", 32, true,
                  dark_fog, 0.03},
        LayerCase{"photon_beams", "ProgressivePhotonMapper { max_depth: 6, photon_walks: 4000, radius: 0.3, media: beams }", 32,
                  true, dark_fog, 0.03},
        LayerCase{"photon_map",
                  "PhotonMapper { max_depth: 6, photon_walks: 20000, farthest: 2, farthest_caustic: 1, caustic_walks: 20000 }",
                  16, true, nullptr, 0.05},
        LayerCase{"instant_radiosity", "InstantRadiosity { max_depth: 6, nearest: 1 }", 16, true, nullptr},
        LayerCase{"many_lights", "ManyLights { max_depth: 6, walks: 200, nearest: 1 }", 16, true, nullptr},
        LayerCase{"primary_sample_metropolis", "PrimarySampleMetropolis { inner: BidirectionalPathTracer { max_depth: 6 } }",
                  32},
        LayerCase{"multiplexed_metropolis", "MultiplexedMetropolis { max_depth: 6 }", 32},
        LayerCase{"path_space_metropolis", "PathSpaceMetropolis { max_depth: 6 }", 32, false, nullptr},
        LayerCase{"distribution", "DistributionRenderer { max_depth: 6 }", 16, true, nullptr},
        LayerCase{"direct", "DirectRenderer {}", 16, false, nullptr},
        LayerCase{"whitted", "WhittedRenderer { max_depth: 6 }", 4, false, nullptr}),
    [](const auto& info) { return info.param.name; });

/// The message of the error that loading or rendering throws; empty: none.
std::string refused(const std::string& renderer, const std::string& layers) {
  return complaint([&] { test::rendered(job_of(room(renderer, layers), 1), two_threads); });
}

TEST(PathLayers, RefuseWhatTheyCannotTell) {
  EXPECT_NE(refused("SimplePathTracer {}", R"("path.all = C.*L")").find("does not tell by which paths"), std::string::npos);
  EXPECT_NE(refused("PhotonMapper { irradiance: true, photon_walks: 20000, farthest: 2 }", R"("path.all = C.*L")")
                .find("does not tell by which paths"),
            std::string::npos);
  EXPECT_NE(refused("PathTracer {}", R"("path.all = C.*Q")").find("character 4"), std::string::npos);
  EXPECT_NE(refused("PathTracer {}", R"("path.all = C.*<L.'kee'>")").find("character 7: nothing in the scene is called 'kee'"),
            std::string::npos);
  EXPECT_NE(refused("PathTracer {}", R"("path.all = C.*<L.'kee'>")").find("did you mean 'key'"), std::string::npos);
  EXPECT_NE(refused("PathTracer {}", R"("path.all")").find("needs a name and"), std::string::npos);
  EXPECT_NE(refused("PathTracer {}", R"("path. = CL")").find("is no name"), std::string::npos);
  EXPECT_NE(refused("PathTracer {}", R"("path.a = CL", "path.a = CB")").find("two layers are called"), std::string::npos);
  EXPECT_NE(refused("PathTracer {}", R"("path.a = LDC")").find("matches no path"), std::string::npos);
  std::string many;
  for (int i = 0; i < 22; ++i) many += fmt::format("{}\"path.a{} = CL\"", i ? ", " : "", i);
  EXPECT_NE(refused("PathTracer {}", many).find("there may be 21"), std::string::npos);
}

// The layers do not change the picture, beside light groups and path lengths, with splats, crops and wide filters; and films
// are the same in bits for any number of threads.
TEST(PathLayers, DoNotChangeThePicture) {
  for (const char* renderer : {"PathTracer { max_depth: 6 }", "BidirectionalPathTracer { max_depth: 6 }"}) {
    const std::string all =
        std::string(division) + R"(, "light.key"], path_lengths: 3, filter: MitchellFilter {}, crop: [2, 1, 7, 6)";
    const auto with = test::rendered(job_of(room(renderer, all), 16), two_threads);
    const auto one = test::rendered(job_of(room(renderer, all), 16), {.threads = 1});
    EXPECT_TRUE(film(*with) == film(*one)) << renderer;
    const auto without =
        test::rendered(job_of(room(renderer, "], filter: MitchellFilter {}, crop: [2, 1, 7, 6"), 16), two_threads);
    const Image a = with->picture(), b = without->picture();
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x)
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(a.at(x, y, c), b.at(x, y, c), 1e-6 * (1e-3 + std::abs(b.at(x, y, c))));
    std::map<std::string, double> mean = means(a);
    double sum = 0, groups = 0;
    for (const auto& [name, value] : mean) {
      if (name.starts_with("path.") && name.ends_with(".Y")) sum += value;
      if (name.starts_with("light.") && name.ends_with(".Y")) groups += value;
    }
    EXPECT_NEAR(sum, mean["Y"], 1e-5 * mean["Y"]) << renderer;
    EXPECT_NEAR(groups, mean["Y"], 1e-5 * mean["Y"]) << renderer;
  }
}

// The parts of a surface that is half matt, half rough metal are those of scenes with one of the two alone.
TEST(PathLayers, DivideTheLobesOfASurface) {
  const auto lit = [](const std::string& renderer, const std::string& shader) {
    return job_of(fmt::format(R"(matt = Lambertian {{ color: rgb(0.8, 0.3, 0.1) }}
      metal = Conductor {{ roughness: 0.4 }}
      Job {{ renderer: {} {{ max_depth: 2 }}
        camera: PerspectiveCamera {{ from: [0, 0, 4], to: [0, 0, 0], fov: 30 }}
        image: ImageBuffer {{ width: 4, height: 4, layers: ["path.matt = C<RD>L", "path.metal = C<RG>L"] }}
        scene: BvhScene {{ objects: [ Sphere {{ radius: 1, shader: {} }}
          Sphere {{ centre: [3, 3, 3], radius: 1, emission: DiffuseEmission {{ radiance: 5 }} }} ] }} }})",
                              renderer, shader),
                  4096);
  };
  const double matt = means(test::rendered(lit("PathTracer", "matt"), two_threads)->picture())["Y"];
  const double metal = means(test::rendered(lit("PathTracer", "metal"), two_threads)->picture())["Y"];
  for (const char* renderer : {"PathTracer", "BidirectionalPathTracer", "LightTracer"}) {
    const auto render = test::rendered(lit(renderer, "MixShader { first: matt, second: metal, amount: 0.25 }"), two_threads);
    std::map<std::string, double> mean = means(render->picture());
    EXPECT_NEAR(mean["path.matt.Y"], 0.75 * matt, 0.02 * matt) << renderer;
    EXPECT_NEAR(mean["path.metal.Y"], 0.25 * metal, 0.02 * metal) << renderer;
  }
}

// An object in an instance has its own name and that of the instance's shader; light that was scattered in a body crosses its
// surface twice.
TEST(PathLayers, KnowInstancesAndBodies) {
  const auto render = test::rendered(job_of(R"(red = Lambertian { color: rgb(0.8, 0.1, 0.1) }
      leaf = Sphere { radius: 0.4, shader: Lambertian { color: 0.5 } }
      Job { renderer: PathTracer { max_depth: 8 }
        camera: PerspectiveCamera { from: [0, 0.3, 3.2], to: [0, 0, 0], fov: 50 }
        image: ImageBuffer { width: 16, height: 12, layers: ["path.emitted = C[LBO]", "path.surfaces = C[^T]+[LBO]",
          "path.bodies = C.*<T.><TD>.*", "path.leaf = C'leaf'.*", "path.red = C'red'.*"] }
        scene: BvhScene { objects: [ Sphere { radius: 0.7, shader: Subsurface {} }
          Instance { scene: BvhScene { objects: [ leaf ] }, shader: red, transform: translate(0.9, 0, 0.5) }
          Environment { emission: EnvironmentEmission { radiance: 1 } } ] } })",
                                            64),
                                     two_threads);
  std::map<std::string, double> mean = means(render->picture());
  EXPECT_GT(mean["path.leaf.Y"], 0.01);
  EXPECT_NEAR(mean["path.red.Y"], mean["path.leaf.Y"], 1e-9);
  EXPECT_GT(mean["path.bodies.Y"], 0.01);
  EXPECT_NEAR(mean["path.emitted.Y"] + mean["path.surfaces.Y"] + mean["path.bodies.Y"], mean["Y"], 1e-6);
}

// Each wavelength of a path that dispersive glass divides keeps its own part of mixed states.
TEST(PathLayers, FollowSingleWavelengths) {
  std::map<std::string, double> truth;
  for (const char* renderer :
       {"PathTracer { max_depth: 6 }", "PathTracer { max_depth: 6, split_wavelengths: 4, split_depth: 2 }",
        "BidirectionalPathTracer { max_depth: 6 }"}) {
    std::string text = room(renderer, R"("path.a = C.+<.D'plastic'>.*", "path.b = C.+<.G'plastic'>.*")");
    const size_t at = text.find("Dielectric {}");
    text.replace(at, 13, "Dielectric { ior: glass(\"N-SF11\") }");
    const auto render = test::rendered(job_of(text, 1024), two_threads);
    std::map<std::string, double> mean = means(render->picture());
    if (truth.empty()) truth = mean;
    for (const auto& [layer, light] : truth) EXPECT_NEAR(mean[layer], light, 0.05 * light) << renderer << ' ' << layer;
  }
}

// Layers are colours in EXR files, as light groups are.
TEST(PathLayers, AreInExrFiles) {
  const std::string file = (std::filesystem::temp_directory_path() / "etendue_path_layers.exr").string();
  const Ref<Job> job = job_of(room("PathTracer { max_depth: 3 }", R"("path.caustics = C<RD>S+L")"), 1);
  const auto render = test::rendered(job, two_threads);
  write_any(render->picture(), file);
  const Image image = read_image(file);
  EXPECT_NE(std::ranges::find(image.channels, "path.caustics.R"), image.channels.end());
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace etendue::checkpoint_test
