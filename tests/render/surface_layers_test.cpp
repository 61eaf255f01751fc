// Layers that show surfaces: their numbers against closed forms, and that they depend on nothing but camera, scene and sampler.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "film/surface_layers.h"
#include "images/cryptomatte.h"
#include "render/mattes/mattes.h"
#include "support/checkpoint_test_support.h"

namespace etendue {
namespace {

using checkpoint_test::complaint;
using checkpoint_test::has;
using test::rendered;

size_t channel(const Image& image, const std::string& name) {
  const auto found = std::ranges::find(image.channels, name);
  EXPECT_NE(found, image.channels.end()) << name;
  return size_t(found - image.channels.begin());
}
double at(const Image& image, int x, int y, const std::string& name) { return image.at(x, y, channel(image, name)); }

std::string description(const std::string& layers, const std::string& objects,
                        const std::string& image = "filter: BoxFilter {}",
                        const std::string& renderer = "PathTracer { samples: 64, max_depth: 1 }",
                        const std::string& camera = "OrthographicCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, width: 4 m }",
                        const std::string& rest = "", const std::string& parts = "") {
  return parts + "Job {\n renderer: " + renderer + "\n camera: " + camera +
         "\n image: ImageBuffer { width: 16, height: 16, layers: [" + layers + "], " + image +
         " }\n scene: BruteForceScene { objects: [\n" + objects + "\n ] }\n" + rest + "}\n";
}
Ref<Job> job(const std::string& text) { return load_job_text(text, "test.etd"); }
template <class... Texts>
Image picture(const Texts&... texts) {
  return rendered(job(description(texts...)), {.threads = 2})->picture();
}

constexpr const char* slope =
    "Rectangle { corner: [-2, -2, -1] m, edge_u: [4, 0, 0] m, edge_v: [0, 4, 2] m, shader: Lambertian { color: 0.4 } }";

// The plane z = y / 2. A pixel is 0.25 m wide; x points to the right and y up. What is linear over a pixel has the value of its
// centre as its mean.
TEST(SurfaceLayers, ShowAPlane) {
  for (const char* filter : {"filter: BoxFilter {}", "filter: GaussianFilter {}", "filter: MitchellFilter {}"}) {
    SCOPED_TRACE(filter);
    const Image image =
        picture(R"("position", "depth", "normal", "geometric_normal", "uv", "albedo", "roughness", "coverage")", slope, filter);
    for (const auto& [x, y] : {std::pair{8, 8}, {3, 11}, {12, 4}}) {
      const double px = -2 + 0.25 * (x + 0.5), py = 2 - 0.25 * (y + 0.5);
      EXPECT_NEAR(at(image, x, y, "position.X"), px, 4e-3);
      EXPECT_NEAR(at(image, x, y, "position.Y"), py, 4e-3);
      EXPECT_NEAR(at(image, x, y, "position.Z"), py / 2, 2e-3);
      EXPECT_NEAR(at(image, x, y, "depth.Z"), 5 - py / 2, 2e-3);
      // The mean of what is linear in one another is, too, whatever the samples.
      EXPECT_NEAR(at(image, x, y, "depth.Z"), 5 - at(image, x, y, "position.Z"), 1e-5);
      EXPECT_NEAR(at(image, x, y, "uv.U"), (at(image, x, y, "position.X") + 2) / 4, 1e-5);
      EXPECT_NEAR(at(image, x, y, "uv.V"), (at(image, x, y, "position.Y") + 2) / 4, 1e-5);
      for (const char* normal : {"normal", "geometric_normal"}) {
        EXPECT_NEAR(at(image, x, y, std::string(normal) + ".X"), 0, 1e-6);
        EXPECT_NEAR(at(image, x, y, std::string(normal) + ".Y"), -1 / std::sqrt(5), 1e-6);
        EXPECT_NEAR(at(image, x, y, std::string(normal) + ".Z"), 2 / std::sqrt(5), 1e-6);
      }
      for (const char* color : {"albedo.R", "albedo.G", "albedo.B"}) EXPECT_NEAR(at(image, x, y, color), 0.4, 0.05) << color;
      EXPECT_EQ(at(image, x, y, "roughness.R"), 1);
      EXPECT_EQ(at(image, x, y, "coverage.A"), 1);
    }
  }
}

// Where paths carry red, green and blue, an albedo is what the scene says, in every space of theirs whose white is sRGB's.
TEST(SurfaceLayers, ShowAlbedosOfPathsInBands) {
  for (const char* space : {"srgb", "rec2020"}) {
    SCOPED_TRACE(space);
    const Image image =
        picture(R"("albedo")",
                "Rectangle { corner: [-2, -2, -1] m, edge_u: [4, 0, 0] m, edge_v: [0, 4, 0] m, shader: Lambertian "
                "{ color: srgb(0.8, 0.4, 0.1) } }",
                "filter: BoxFilter {}", "PathTracer { samples: 1, max_depth: 1 }",
                "OrthographicCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, width: 4 m }",
                std::string("wavelengths: RgbWavelengths { color_space: \"") + space + "\" }\n");
    // srgb() takes encoded values (IEC 61966-2-1): ((v + 0.055) / 1.055)^2.4.
    EXPECT_NEAR(at(image, 8, 8, "albedo.R"), std::pow(0.855 / 1.055, 2.4), 2e-3);
    EXPECT_NEAR(at(image, 8, 8, "albedo.G"), std::pow(0.455 / 1.055, 2.4), 2e-3);
    EXPECT_NEAR(at(image, 8, 8, "albedo.B"), std::pow(0.155 / 1.055, 2.4), 2e-3);
  }
}

TEST(SurfaceLayers, ShowASphereWithoutItsBackground) {
  const Image image = picture(R"("position", "normal", "depth", "coverage")", "Sphere { radius: 1 m, shader: Lambertian {} }");
  double covered = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const double coverage = at(image, x, y, "coverage.A");
      covered += coverage / 16;  // [m^2]
      for (const char* axis : {".X", ".Y", ".Z"}) {
        // The normal is the position on a unit sphere. Positions are means over what is seen, normals over the whole pixel.
        const double mean = at(image, x, y, std::string("position") + axis) * coverage;
        EXPECT_NEAR(at(image, x, y, std::string("normal") + axis), mean, 1e-5) << x << " " << y;
      }
      if (coverage == 0) EXPECT_EQ(at(image, x, y, "depth.Z"), 0);
      if (coverage > 0) EXPECT_NEAR(at(image, x, y, "depth.Z"), 5 - at(image, x, y, "position.Z"), 1e-5);
    }
  EXPECT_NEAR(covered, 3.14159265, 0.01);
}

// Far from the origin floats would have steps of 0.06 m.
TEST(SurfaceLayers, PositionsAreThoseOfTheWorld) {
  const Image image =
      picture(R"("position")", "Rectangle { corner: [999998, -2, 0] m, edge_u: [4, 0, 0] m, edge_v: [0, 4, 0] m }",
              "filter: BoxFilter {}", "PathTracer { samples: 64, max_depth: 1 }",
              "OrthographicCamera { from: [1000000, 0, 5] m, to: [1000000, 0, 0] m, width: 4 m }");
  EXPECT_NEAR(at(image, 8, 8, "position.X") - 1e6, 0.125, 4e-3);
}

TEST(SurfaceLayers, ShadersSayHowRoughTheyAre) {
  const auto roughness = [](const std::string& shader) {
    return at(picture(R"("roughness")",
                      "Rectangle { corner: [-2, -2, 0] m, edge_u: [4, 0, 0] m, edge_v: [0, 4, 0] m, shader: " + shader + " }",
                      "filter: GaussianFilter {}"),
              8, 8, "roughness.R");
  };
  EXPECT_NEAR(roughness("Conductor { roughness: 0.3 }"), 0.3, 1e-6);
  EXPECT_NEAR(roughness("Conductor { roughness: 0.2, roughness_v: 0.4 }"), 0.3, 1e-6);
  EXPECT_EQ(roughness("PerfectSpecular {}"), 0);
  EXPECT_EQ(roughness("OrenNayar { roughness: 0.1 }"), 1);
  // No member says it: 1 for a Lambertian part, 0 for a mirror, by the spread of the light of both.
  EXPECT_NEAR(roughness("MixShader { first: PerfectSpecular {}, second: Lambertian { color: 1 }, amount: 0.5 }"),
              1.8 * (1 - std::pow(0.5 + 0.5 * 2 / 3, 2)), 0.15);
}

// ---- motion ----------------------------------------------------------------------------------------------------------------

/// The motion through a shutter of one second of what moves uniformly on the film, by (x, y) pixels.
void expect_motion(const Image& image, int px, int py, double x, double y) {
  const auto value = [&](const char* name) { return at(image, px, py, name); };
  EXPECT_NEAR(value("motion.next.X") - value("motion.previous.X"), x, 2e-3);
  EXPECT_NEAR(value("motion.next.Y") - value("motion.previous.Y"), y, 2e-3);
  // Times are spread evenly over the shutter.
  EXPECT_NEAR(value("motion.next.X"), x / 2, 0.02 * std::abs(x) + 2e-3);
  EXPECT_NEAR(value("motion.previous.Y"), -y / 2, 0.02 * std::abs(y) + 2e-3);
}

constexpr const char* open_shutter =
    "OrthographicCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, width: 4 m, shutter_close: 1 s }";
constexpr const char* usual = "PathTracer { samples: 64, max_depth: 1 }";
constexpr const char* box = "filter: BoxFilter {}";

// 0.5 m/s to the right and 0.25 m/s up at 4 pixels per metre; an instance adds 1 m/s to the left.
TEST(SurfaceLayers, MotionIsThatOfTheObject) {
  const std::string wall = "corner: [-8, -8, 0] m, edge_u: [16, 0, 0] m, edge_v: [0, 16, 0] m";
  const std::string moves = "transform: keyframes(0 s, translate(0, 0, 0), 1 s, translate(0.5, 0.25, 0))";
  expect_motion(picture(R"("motion")", "Rectangle { " + wall + ", " + moves + " }", box, usual, open_shutter), 8, 8, 2, -1);
  const std::string instance =
      "Instance { scene: inner, transform: keyframes(0 s, translate(0, 0, 0), 1 s, translate(-1, 0, 0)) }";
  expect_motion(picture(R"("motion")", instance, box, usual, open_shutter, "",
                        "inner = BruteForceScene { objects: [ Rectangle { " + wall + ", " + moves + " } ] }\n"),
                8, 8, -2, -1);
  // Nothing moves.
  const Image still = picture(R"("motion")", "Rectangle { " + wall + " }", box, usual, open_shutter);
  for (const char* name : {"motion.previous.X", "motion.previous.Y", "motion.next.X", "motion.next.Y"})
    EXPECT_EQ(at(still, 8, 8, name), 0);
}

TEST(SurfaceLayers, MotionIsThatOfTheVerticesOfAMesh) {
  const std::string mesh =
      "TriangleMesh { positions: [[-8, -8, 0], [8, -8, 0], [8, 8, 0], [-8, 8, 0]] m, triangles: [[0, 1, 2], [0, 2, 3]],\n"
      " times: [0, 1] s, motion_positions: [[-7, -8, 0], [9, -8, 0], [9, 8, 0], [-7, 8, 0]] m }";
  expect_motion(picture(R"("motion")", mesh, box, usual, open_shutter), 8, 8, 4, 0);
}

// The camera moves to the right by 0.5 m: all that is seen moves to the left.
TEST(SurfaceLayers, MotionIsThatOfTheCamera) {
  const Image image =
      picture(R"("motion")", "Rectangle { corner: [-8, -8, 0] m, edge_u: [16, 0, 0] m, edge_v: [0, 16, 0] m }", box, usual,
              "OrthographicCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, width: 4 m, shutter_close: 1 s, transform: "
              "keyframes(0 s, translate(0, 0, 0), 1 s, translate(0.5, 0, 0)) }");
  expect_motion(image, 8, 8, -2, 0);
}

// A pinhole at 5 m with a picture 2 * 5 tan(20 deg) m wide. In a second the wall moves by more than that: points leave the
// film.
TEST(SurfaceLayers, MotionLeadsBeyondTheEdgesOfTheFilm) {
  const std::string wall =
      "Rectangle { corner: [-20, -20, 0] m, edge_u: [40, 0, 0] m, edge_v: [0, 40, 0] m, transform: "
      "keyframes(0 s, translate(0, 0, 0), 1 s, translate(6, 0, 0)) }";
  for (const char* lens : {"", ", lens_radius: 0.2 m, focus_distance: 5 m"}) {
    const Image image = picture(
        R"("motion")", wall, box, usual,
        std::string("PerspectiveCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, fov: 40 deg, shutter_close: 1 s") + lens + " }");
    expect_motion(image, 8, 8, 6 * 16 / (10 * std::tan(20 * pi / 180)), 0);
  }
  // Towards the camera, which it passes: the point is not seen any more, and there is no motion to it.
  const Image passed =
      picture(R"("motion")",
              "Rectangle { corner: [-20, -20, 0] m, edge_u: [40, 0, 0] m, edge_v: [0, 40, 0] m, transform: "
              "keyframes(0 s, translate(0, 0, 0), 1 s, translate(0, 0, 12)) }",
              box, usual, "PerspectiveCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, fov: 40 deg, shutter_close: 1 s }");
  EXPECT_EQ(at(passed, 8, 8, "motion.next.X"), 0);
  EXPECT_TRUE(std::isfinite(at(passed, 8, 8, "motion.previous.X")));
}

TEST(SurfaceLayers, MotionOfAnInstantNeedsADuration) {
  const std::string wall =
      "Rectangle { corner: [-8, -8, 0] m, edge_u: [16, 0, 0] m, edge_v: [0, 16, 0] m, transform: "
      "keyframes(0 s, translate(0, 0, 0), 1 s, translate(1, 0, 0)) }";
  const std::string camera =
      "OrthographicCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, width: 4 m, shutter_open: 0.5 s, shutter_close: 0.5 s }";
  EXPECT_TRUE(has(complaint([&] { picture(R"("motion")", wall, box, usual, camera); }), "'motion = 0.04'"));
  const Image image = picture(R"("motion = 0.25")", wall, box, usual, camera);
  EXPECT_NEAR(at(image, 8, 8, "motion.next.X"), 1, 1e-3);
  EXPECT_NEAR(at(image, 8, 8, "motion.previous.X"), -1, 1e-3);
}

// ---- identifiers and mattes
// --------------------------------------------------------------------------------------------------

const std::string parts =
    "paint = Lambertian { color: 0.5 }\n"
    "left = Rectangle { corner: [-2, -2, 0] m, edge_u: [1.875, 0, 0] m, edge_v: [0, 4, 0] m, shader: paint }\n"
    "right = Rectangle { corner: [-0.125, -2, 0] m, edge_u: [1.125, 0, 0] m, edge_v: [0, 4, 0] m, shader: Lambertian {} }\n"
    "leaf = Rectangle { corner: [1, -2, 0] m, edge_u: [0.5, 0, 0] m, edge_v: [0, 4, 0] m, shader: paint }\n"
    "tree = BruteForceScene { objects: [ leaf ] }\n";
const std::string things = "left, right, tree_2";
const std::string tree_2 = "tree_2 = Instance { scene: tree }\n";
const std::string groups =
    " groups: [ ObjectGroup { name: \"plants\", objects: [\"tree*\"] }, ObjectGroup { name: \"all\", objects: [\"*\"] } ]\n";
const std::string all_mattes =
    R"("crypto_object", "crypto_material = 2", "crypto_asset", "crypto_group", "object", "material", "primitive")";

std::string matte_job(const std::string& image = box, const std::string& renderer = usual,
                      const std::string& layers = all_mattes,
                      const std::string& camera = "OrthographicCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, width: 4 m }") {
  return description(layers, things, image, renderer, camera, groups, parts + tree_2);
}

// The edge at x = -0.125 m divides the pixels of column 7, and nothing is beyond x = 1.5 m.
TEST(SurfaceLayers, IdentifiersAreThoseOfTheSampleAtTheCentre) {
  const Image image = rendered(job(matte_job("filter: GaussianFilter {}")), {.threads = 2})->picture();
  for (int y = 0; y < 16; ++y) {
    EXPECT_EQ(at(image, 3, y, "object.ID"), 1);
    EXPECT_EQ(at(image, 10, y, "object.ID"), 2);
    EXPECT_EQ(at(image, 13, y, "object.ID"), 3);
    EXPECT_EQ(at(image, 15, y, "object.ID"), 0);
    EXPECT_EQ(at(image, 3, y, "material.ID"), 1);
    EXPECT_EQ(at(image, 10, y, "material.ID"), 2);
    EXPECT_EQ(at(image, 13, y, "material.ID"), 1);
    EXPECT_GE(at(image, 3, y, "primitive.ID"), 1);  // a rectangle has two triangles
    EXPECT_LE(at(image, 3, y, "primitive.ID"), 2);
    EXPECT_EQ(at(image, 15, y, "primitive.ID"), 0);
  }
  // 1/3 of a pixel belongs to the left: with many samples the nearest one is on the right.
  std::string moved = matte_job();
  for (const auto& [from, to] : {std::pair{"1.875", "1.8333"}, {"-0.125", "-0.1667"}, {"1.125", "1.1667"}})
    moved.replace(moved.find(from), std::string(from).size(), to);
  const Image third = rendered(job(moved), {.threads = 2})->picture();
  for (int y = 0; y < 16; ++y) EXPECT_EQ(at(third, 7, y, "object.ID"), 2) << y;
}

TEST(SurfaceLayers, MattesOfObjectsMaterialsAssetsAndGroups) {
  const Image image = rendered(job(matte_job()), {.threads = 2})->picture();
  std::map<std::string, Cryptomatte> kinds;
  for (Cryptomatte& kind : cryptomattes_of(image)) kinds[kind.name] = kind;
  ASSERT_EQ(kinds.size(), 4u);
  const auto coverage = [&](const std::string& kind, const std::string& name, int x) {
    const Cryptomatte& mattes = kinds.at(kind);
    return coverage_of(mattes, mattes.manifest.at(name))[size_t(5 * 16 + x)];
  };
  EXPECT_FLOAT_EQ(coverage("crypto_object", "left", 7), 0.5f);
  EXPECT_FLOAT_EQ(coverage("crypto_object", "right", 7), 0.5f);
  EXPECT_FLOAT_EQ(coverage("crypto_object", "tree_2/leaf", 12), 1);
  EXPECT_FLOAT_EQ(coverage("crypto_asset", "tree_2", 12), 1);
  EXPECT_FLOAT_EQ(coverage("crypto_material", "paint", 12), 1);
  EXPECT_FLOAT_EQ(coverage("crypto_group", "plants", 12), 1);
  EXPECT_FLOAT_EQ(coverage("crypto_group", "all", 7), 1);
  EXPECT_FLOAT_EQ(coverage("crypto_group", "all", 12), 0);
  EXPECT_EQ(kinds.at("crypto_group").manifest.size(), 2u);
  // As many channels as are asked for, however few names there are.
  EXPECT_EQ(std::ranges::count_if(image.channels, [](const std::string& c) { return c.starts_with("crypto_object"); }), 12);
  EXPECT_EQ(std::ranges::count_if(image.channels, [](const std::string& c) { return c.starts_with("crypto_material"); }), 4);
}

TEST(SurfaceLayers, AreTheMattesOfTheCommand) {
  const Ref<Job> described = job(matte_job("filter: GaussianFilter {}"));
  const auto render = rendered(described, {.threads = 2});
  const std::vector<Cryptomatte> layers = cryptomattes_of(render->picture());
  const std::vector<Cryptomatte> alone = render_mattes(*render, 2, [](double) { return true; });
  ASSERT_EQ(layers.size(), alone.size());
  for (const Cryptomatte& kind : alone) {
    const auto found = std::ranges::find(layers, kind.name, &Cryptomatte::name);
    ASSERT_NE(found, layers.end());
    EXPECT_EQ(found->manifest, kind.manifest);
    for (size_t i = 0; i < kind.pixels.size(); ++i) {
      ASSERT_EQ(found->pixels[i].size(), kind.pixels[i].size());
      for (size_t r = 0; r < kind.pixels[i].size(); ++r) EXPECT_EQ(found->pixels[i][r].coverage, kind.pixels[i][r].coverage);
    }
  }
}

// ---- the same bits
// -----------------------------------------------------------------------------------------------------------

const std::string every_layer =
    all_mattes +
    R"(, "position", "depth", "normal", "geometric_normal", "uv", "albedo", "roughness", "coverage", "motion = 0.1")";

/// The values of the layers of surfaces alone.
std::vector<double> layers_of(const Image& image) {
  std::vector<double> values;
  for (size_t c = 0; c < image.channels.size(); ++c)
    if (image.channels[c].find('.') != std::string::npos)
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) values.push_back(image.at(x, y, c));
  return values;
}

TEST(SurfaceLayers, AreTheSameWithEveryRenderer) {
  const auto layers = [&](const std::string& renderer) {
    return layers_of(
        rendered(job(matte_job("filter: GaussianFilter {}", renderer + " { samples: 3 }", every_layer,
                               "PerspectiveCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, fov: 44 deg, lens_radius: 0.2 m }")),
                 {.threads = 2})
            ->picture());
  };
  const std::vector<double> expected = layers("PathTracer");
  EXPECT_GT(std::ranges::count_if(expected, [](double v) { return v != 0; }), 1000);
  for (const char* renderer : {"LightTracer", "BidirectionalPathTracer", "PrimarySampleMetropolis", "PathSpaceMetropolis",
                               "DirectRenderer", "FeatureRenderer"})
    EXPECT_TRUE(layers(renderer) == expected) << renderer;
  // These have other steps, of one sample, so that sums are rounded elsewhere.
  for (const char* renderer : {"ProgressivePhotonMapper", "VertexConnectionMerging"}) {
    const std::vector<double> found = layers(renderer);
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i)
      ASSERT_NEAR(found[i], expected[i], 1e-12 * (1 + std::abs(expected[i]))) << renderer;
  }
}

TEST(SurfaceLayers, BitsDoNotDependOnThreadsNorCrops) {
  const auto made = [&](const std::string& crop, int threads) {
    return rendered(job(matte_job("filter: GaussianFilter {}" + crop, usual, every_layer)), {.threads = threads})->picture();
  };
  const Image one = made("", 1), two = made("", 2), part = made(", crop: [5, 4, 10, 14]", 2);
  EXPECT_TRUE(layers_of(one) == layers_of(two));
  ASSERT_EQ(part.channels, one.channels);
  for (size_t c = 3; c < part.channels.size(); ++c)
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 5; ++x) ASSERT_EQ(part.at(x, y, c), one.at(x + 5, y + 4, c)) << part.channels[c];
}

class SurfaceStates : public checkpoint_test::CheckpointTest {
 protected:
  static Ref<Job> described(int samples) {
    // So few pixels that a step has 16384 samples of each.
    const std::string text = checkpoint_test::ball_text("PathTracer { max_depth: 2 }", "width: 2, layers: [" + layers + "]");
    return checkpoint_test::job_of(text, samples);
  }
  static inline const std::string layers = R"("crypto_object", "object", "position", "motion = 0.5", "normal", "coverage")";
};

TEST_F(SurfaceStates, merge_in_any_order_and_continue) {
  using checkpoint_test::step;
  const int samples = 3 * step + 77;
  const auto straight = rendered(described(samples), {.threads = 2});
  const std::string a = part(described(samples), "a", IndexRange{0, 1}), b = part(described(samples), "b", IndexRange{1, 2}),
                    c = part(described(samples), "c", IndexRange{2, 4});
  const Checkpoint merged = merge_checkpoints({c, a, b}), other = merge_checkpoints({b, c, a});
  EXPECT_TRUE(merged.state.surfaces == other.state.surfaces);
  checkpoint_test::expect_same(merged, *straight);
  write_checkpoint(merge_checkpoints({c, a}), folder / "ac");
  EXPECT_TRUE(checkpoint_test::continued(described(samples), folder / "ac")->picture().values == straight->picture().values);
  // After a short step, with more samples.
  part(described(step + 50), "short");
  EXPECT_TRUE(checkpoint_test::continued(described(samples), folder / "short")->picture().values == straight->picture().values);
}

TEST_F(SurfaceStates, damaged_ones_are_refused) {
  const std::string file = part(described(10), "state");
  const Checkpoint good = read_checkpoint(file);
  ASSERT_GT(good.state.surfaces.size(), 100u);
  const auto tried = [&](std::vector<std::byte> surfaces) {
    Checkpoint bad = good;
    bad.state.surfaces = std::move(surfaces);
    return complaint([&] { picture_of(bad); });
  };
  EXPECT_EQ(tried(good.state.surfaces), "");
  for (size_t length = 0; length < good.state.surfaces.size(); ++length)
    EXPECT_NE(tried({good.state.surfaces.begin(), good.state.surfaces.begin() + std::ptrdiff_t(length)}), "") << length;
  std::vector<std::byte> longer = good.state.surfaces;
  longer.push_back({});
  EXPECT_TRUE(has(tried(longer), "longer than it should be"));
}

TEST(SurfaceLayers, StartOverWhenTheyAreAskedForLater) {
  const Ref<Job> described = job(matte_job(box, usual, R"("variance")"));
  Render render(described, {.threads = 2});
  EXPECT_EQ(render.run(), Ended::samples);
  render.edit(*described->image, "layers", Value(Value::List{Value(std::string("crypto_group")), Value(std::string("depth"))}));
  EXPECT_EQ(render.run(), Ended::samples);
  const Image image = render.picture();
  EXPECT_NEAR(at(image, 8, 8, "depth.Z"), 5, 1e-5);
  EXPECT_EQ(cryptomattes_of(image).at(0).manifest.size(), 2u);
  render.edit(*described->groups[0], "name", Value(std::string("trees")));
  EXPECT_EQ(render.run(), Ended::samples);
  EXPECT_TRUE(cryptomattes_of(render.picture()).at(0).manifest.contains("trees"));
}

// ---- what is wrong
// -----------------------------------------------------------------------------------------------------------

TEST(SurfaceLayers, MistakesAreSaid) {
  const auto error = [&](const std::string& layers, const std::string& rest = groups) {
    return complaint([&] {
      Render(job(description(layers, things, box, usual,
                             "OrthographicCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, width: 4 m }", rest, parts + tree_2)));
    });
  };
  EXPECT_EQ(error(all_mattes), "");
  EXPECT_TRUE(has(error(R"("depht")"), "'depth'"));
  EXPECT_NE(error(R"("depth = 3")"), "");
  EXPECT_TRUE(has(complaint([&] { SurfaceLayers().take("depth = 3"); }), "takes no number"));
  EXPECT_TRUE(has(error(R"("crypto_object = many")"), "from 1 to 200"));
  EXPECT_TRUE(has(error(R"("crypto_object", "crypto_object = 4")"), "named twice"));
  EXPECT_TRUE(has(error(R"("motion = -1")"), "duration in seconds"));
  EXPECT_TRUE(has(error(R"("motion")"), "open for no time"));
  EXPECT_TRUE(has(error(R"("crypto_group")", ""), "needs groups"));
  EXPECT_TRUE(
      has(error(R"("depth")", " groups: [ ObjectGroup { name: \"a\", objects: [\"lefd\"] } ]\n"), "did you mean 'left'"));
  EXPECT_TRUE(has(error(R"("depth")", " groups: [ ObjectGroup { name: \"\", objects: [\"left\"] } ]\n"), "needs a name"));
  EXPECT_TRUE(has(error(R"("depth")",
                        " groups: [ ObjectGroup { name: \"a\", objects: [\"left\"] }, ObjectGroup { name: \"a\", objects: "
                        "[\"right\"] } ]\n"),
                  "two groups are called 'a'"));
}

TEST(SurfaceLayers, PatternsOfNames) {
  const auto matches = [](const char* pattern, const NamePath& path) { return NamePattern(pattern).matches(path); };
  EXPECT_TRUE(matches("leaf", {"tree", "leaf"}));
  EXPECT_TRUE(matches("tree", {"tree", "leaf"}));
  EXPECT_TRUE(matches("tree/leaf", {"wood", "tree", "leaf"}));
  EXPECT_FALSE(matches("wood/leaf", {"wood", "tree", "leaf"}));
  EXPECT_TRUE(matches("*e", {"tree"}));
  EXPECT_TRUE(matches("t*e*e", {"tree"}));
  EXPECT_FALSE(matches("t*x*e", {"tree"}));
  EXPECT_TRUE(matches("*", {"anything"}));
  EXPECT_FALSE(matches("tre", {"tree"}));
}

}  // namespace
}  // namespace etendue
