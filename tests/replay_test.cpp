// Samples computed again, the samples that brought most light, and what renderers cannot find.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "app/advice.h"
#include "app/fireflies.h"
#include "app/replay.h"
#include "process.h"
#include "render_support.h"

namespace etendue {
namespace {

const char* const camera = "PerspectiveCamera { from: [0, 2, -6] m, to: [0, 0, 0] m, fov: 45 deg }";
const char* const floor_disc =
    R"(Disc { radius: 5 m, transform: translate(0, -1 m, 0) * rotate(-90, "x"), shader: Lambertian { color: 0.6 } })";
const char* const glass_ball = R"(Sphere { radius: 1 m, shader: Dielectric { ior: glass("N-SF11") } })";
const char* const round_lamp = "Sphere { center: [1, 3, 0] m, radius: 0.3 m, emission: DiffuseEmission { radiance: 50 } }";

std::string objects(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += part + "\n";
  return text;
}

Ref<Job> prepared(const std::string& text) {
  Ref<Job> job = load_job_text(text, "test.etd");
  prepare_tree(*job);
  return job;
}

/// A lamp that dispersing glass gathers on a floor: dim paths, and a few bright ones.
std::string glass_text(int samples) {
  return test::job_text(
      "PathTracer { samples: " + std::to_string(samples) + " }", camera, 16,
      objects({floor_disc, glass_ball, round_lamp, "Environment { emission: DiffuseEmission { radiance: 0.1 } }"}));
}

constexpr int px = 6, py = 10;  // on the floor, where the glass gathers light

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// ---- replay -------------------------------------------------------------------------------------------------------------

TEST(Replay, json_tells_where_all_light_of_a_pixel_comes_from) {
  const Ref<Job> job = prepared(glass_text(64));
  const PixelReplay replay = replay_pixel(*job, px, py, 64);
  const auto json = nlohmann::json::parse(replay_json(*job, replay, "test.etd", "etendue render test.etd"));
  EXPECT_EQ(json["file"], "test.etd");
  EXPECT_EQ(json["renderer"], "PathTracer");
  EXPECT_EQ(json["seed"], 0);
  EXPECT_EQ(json["pixel"], nlohmann::json({px, py}));
  EXPECT_EQ(json["samples"], 64);
  ASSERT_EQ(json["paths"].size(), 64u);

  double shares = 0, sum = 0, before = std::numeric_limits<double>::infinity();
  int lit = 0, several = 0, single = 0;
  std::set<int> samples;
  for (const auto& path : json["paths"]) {
    const double luminance = path["luminance"];
    EXPECT_LE(luminance, before) << "the brightest come first";
    before = luminance;
    sum += luminance;
    shares += path["share"].get<double>();
    samples.insert(path["sample"].get<int>());
    EXPECT_EQ(path["command"], "etendue render test.etd --pixel 6,10 --sample " + std::to_string(path["sample"].get<int>()));
    EXPECT_EQ(std::floor(path["film"][0].get<double>()), px);
    EXPECT_EQ(std::floor(path["film"][1].get<double>()), py);
    EXPECT_EQ(path["vertices"][0]["kind"], "camera");
    EXPECT_FALSE(path["bad"].get<bool>());

    std::vector<double> total(spectrum_size, 0.0);
    double of_contributions = 0;
    for (const auto& c : path["contributions"]) {
      EXPECT_FALSE(c["splat"].get<bool>());
      EXPECT_FALSE(c["strategy"].get<std::string>().empty());
      EXPECT_GE(c["length"], 1);
      EXPECT_EQ(c["film"], path["film"]);
      of_contributions += c["luminance"].get<double>();
      for (size_t i = 0; i < total.size(); ++i) total[i] += c["value"][i].get<double>();
    }
    for (size_t i = 0; i < total.size(); ++i) {
      const double result = path["result"][i];
      EXPECT_NEAR(total[i], result, 1e-5 * (1 + result)) << "sample " << path["sample"] << " wavelength " << i;
      EXPECT_GT(path["densities"][i], 0);
      EXPECT_GE(path["wavelengths"][i], 360);
    }
    EXPECT_NEAR(of_contributions, luminance, 1e-5 * (1 + luminance));
    lit += luminance > 0;
    several += path["contributions"].size() > 1;
    single += path["single"].get<bool>();
  }
  EXPECT_NEAR(shares, 1, 1e-9);
  EXPECT_EQ(samples.size(), 64u) << "each sample once";
  EXPECT_NEAR(sum / 64, json["luminance"].get<double>(), 1e-9 * sum);
  EXPECT_GT(lit, 32);
  EXPECT_GT(several, 8);
  EXPECT_GT(single, 8);
}

TEST(Replay, a_pixel_is_what_the_picture_has_there) {
  const Ref<Job> job = prepared(glass_text(48));
  const PixelReplay replay = replay_pixel(*job, px, py, 1);
  ASSERT_TRUE(replay.luminance);
  job->render();
  const double in_picture = job->picture().at(px, py, 1);
  EXPECT_GT(in_picture, 0);
  EXPECT_NEAR(*replay.luminance, in_picture, 1e-9 * in_picture);
}

TEST(Replay, the_brightest_are_the_same_however_many_are_asked_for_and_on_any_number_of_threads) {
  const Ref<Job> job = prepared(glass_text(3000));  // several parts
  job->threads = 1;
  const PixelReplay many = replay_pixel(*job, px, py, 3000);
  ASSERT_EQ(many.paths.size(), 3000u);
  for (const int threads : {1, 2, 5}) {
    job->threads = threads;
    const PixelReplay few = replay_pixel(*job, px, py, 4);
    EXPECT_EQ(*few.luminance, *many.luminance);
    ASSERT_EQ(few.paths.size(), 4u);
    double shares = 0;
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(few.paths[i].sample, many.paths[i].sample) << i;
      EXPECT_EQ(few.paths[i].luminance, many.paths[i].luminance) << i;
      EXPECT_EQ(*few.paths[i].share, *many.paths[i].share) << i;
      shares += *few.paths[i].share;
    }
    EXPECT_GT(shares, 0);
    EXPECT_LT(shares, 1);
  }
}

TEST(Replay, one_sample_is_told_alone) {
  const Ref<Job> job = prepared(glass_text(16));
  const PixelReplay all = replay_pixel(*job, px, py, 16);
  const PixelReplay one = replay_sample(*job, px, py, all.paths[0].sample);
  ASSERT_EQ(one.paths.size(), 1u);
  EXPECT_EQ(one.paths[0].luminance, all.paths[0].luminance);
  EXPECT_EQ(one.paths[0].record.contributions.size(), all.paths[0].record.contributions.size());
  EXPECT_FALSE(one.paths[0].share);
  const auto json = nlohmann::json::parse(replay_json(*job, one, "a.etd", "etendue render a.etd"));
  EXPECT_TRUE(json["luminance"].is_null());
  EXPECT_TRUE(json["paths"][0]["share"].is_null());
  EXPECT_FALSE(has(replay_text(one, "c"), "is not in it"));
  EXPECT_TRUE(has(replay_text(replay_sample(*job, px, py, 16), "c"), "samples 0 to 15; this one is not in it"));
  EXPECT_THROW(replay_sample(*job, 16, 0, 0), Error);
  EXPECT_THROW(replay_pixel(*job, 0, -1, 1), Error);
}

TEST(Replay, a_black_pixel_has_no_shares) {
  const Ref<Job> job = prepared(test::job_text("PathTracer { samples: 4 }", camera, 16, floor_disc));
  const PixelReplay replay = replay_pixel(*job, px, py, 5);
  EXPECT_EQ(*replay.luminance, 0);
  ASSERT_EQ(replay.paths.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(replay.paths[i].sample, i);
    EXPECT_FALSE(replay.paths[i].share);
  }
}

// ---- splats and bad samples ---------------------------------------------------------------------------------------------

/// Brings a little to its own pixel and much to two places, of which one lies beside the picture. Some samples are no
/// numbers,
/// some negative in part.
class Sprinkler final : public Renderer {
 public:
  Spectrum radiance(const RenderContext&, const Ray&, SampleContext& sample) const override {
    const float u = sample.random.next();
    Spectrum own(0.001f * u);
    if (u < 0.12f)
      own.set(1, std::numeric_limits<float>::quiet_NaN());
    else if (u < 0.25f)
      own.set(1, -0.0001f);  // the colour of the whole is positive all the same
    for (const Point2 film : {Point2(2.5f, 3.25f), Point2(-4.0f, 3.0f)}) {
      sample.splat(film, Spectrum(u), sample.wavelengths, 3);
      if (sample.record) sample.record->contributions.push_back({"1 from the luminaire", 3, 1, Spectrum(u), film, true});
    }
    if (sample.record) sample.record->contributions.push_back({"met", 1, 1, own, {}, false});
    return own;
  }
};

TEST(Replay, splats_and_bad_samples_are_told) {
  const Ref<Job> job = prepared(glass_text(64));
  const Ref<Renderer> path_tracer = job->renderer;
  job->renderer = Ref<Renderer>(new Sprinkler);
  job->renderer->samples = 64;
  const PixelReplay replay = replay_pixel(*job, px, py, 64);
  double before = std::numeric_limits<double>::infinity(), shares = 0;
  int bad = 0;
  for (const ReplayedPath& path : replay.paths) {
    EXPECT_LE(path.luminance + path.splatted, before);
    before = path.luminance + path.splatted;
    shares += *path.share;
    bad += path.bad;
    const float u = path.record.contributions[0].value[0];
    EXPECT_EQ(path.bad, u < 0.25f);
    EXPECT_EQ(path.luminance == 0, path.bad);
    EXPECT_NEAR(path.splatted, to_xyz(Spectrum(u), path.record.wavelengths).y, 1e-9);
  }
  EXPECT_NEAR(shares, 1, 1e-9);
  EXPECT_GT(bad, 4);
  EXPECT_LT(bad, 40);
  const std::string text = replay_text(replay, "etendue render a.etd");
  EXPECT_TRUE(has(text, "falls at (2.500000, 3.250000)")) << text.substr(0, 2000);
  EXPECT_TRUE(has(text, "it counts as black"));

  job->renderer = path_tracer;  // one that has a name
  const auto json = nlohmann::json::parse(replay_json(*job, replay, "a.etd", "etendue render a.etd"));
  const auto& path = json["paths"][0];
  EXPECT_EQ(path["contributions"][0]["film"], nlohmann::json({2.5, 3.25}));
  EXPECT_TRUE(path["contributions"][0]["splat"].get<bool>());
  EXPECT_NEAR(path["contributions"][0]["luminance"].get<double>(), path["splatted"].get<double>(), 1e-9);
  int without_number = 0;
  for (const auto& other : json["paths"]) {
    if (!other["result"][1].is_null()) continue;
    EXPECT_TRUE(other["bad"].get<bool>());
    ++without_number;
  }
  EXPECT_GT(without_number, 0);
  EXPECT_LT(without_number, bad) << "some are negative";
}

// ---- fireflies ----------------------------------------------------------------------------------------------------------

struct Listed {
  int x = 0, y = 0;
  std::uint32_t sample = 0;
  double luminance = 0, ratio = 0;
};

std::vector<Listed> listed_in(const std::string& text) {
  std::vector<Listed> list;
  const std::regex line(R"(--pixel (\d+),(\d+) --sample (\d+)    # Y ([0-9.e+-]+)[^\n]*, ([0-9.e+-]+) times its pixel's)");
  for (std::sregex_iterator at(text.begin(), text.end(), line), end; at != end; ++at)
    list.push_back({std::stoi((*at)[1]), std::stoi((*at)[2]), std::uint32_t(std::stoul((*at)[3])), std::stod((*at)[4]),
                    std::stod((*at)[5])});
  return list;
}

TEST(Fireflies, those_listed_are_the_brightest_and_replay_to_the_same) {
  const Ref<Job> job = prepared(glass_text(8));
  job->image->keep_largest(5);
  job->render();
  const std::string text = fireflies_text(*job, "etendue render a.etd -D n=1");
  const std::vector<Listed> list = listed_in(text);
  ASSERT_EQ(list.size(), 5u) << text;
  EXPECT_TRUE(has(text, "  etendue render a.etd -D n=1 --pixel ")) << text;
  const Image picture = job->picture();
  const std::vector<LargeSample> largest = job->image->largest_samples();
  for (size_t i = 0; i < list.size(); ++i) {
    const Listed& l = list[i];
    if (i > 0) {
      EXPECT_LE(l.luminance, list[i - 1].luminance);
    }
    const PixelReplay replay = replay_sample(*job, l.x, l.y, l.sample);
    EXPECT_DOUBLE_EQ(replay.paths[0].luminance, largest[i].luminance);
    EXPECT_NEAR(replay.paths[0].luminance, l.luminance, 1e-5 * l.luminance);
    EXPECT_NEAR(l.ratio, l.luminance / picture.at(l.x, l.y, 1), 1e-3 * l.ratio);
  }
  double brightest = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) brightest = std::max(brightest, replay_pixel(*job, x, y, 1).paths[0].luminance);
  EXPECT_DOUBLE_EQ(brightest, largest[0].luminance);
}

TEST(Fireflies, places_in_a_crop_and_of_splats) {
  const Ref<Job> job = prepared(glass_text(8));
  job->image->crop = {2, 3, 12, 13};
  prepare_tree(*job);
  job->image->keep_largest(3);
  job->render();
  const Image picture = job->picture();
  const std::vector<Listed> list = listed_in(fireflies_text(*job, "c"));
  ASSERT_EQ(list.size(), 3u);
  for (const Listed& l : list) EXPECT_NEAR(l.ratio, l.luminance / picture.at(l.x - 2, l.y - 3, 1), 1e-3 * l.ratio);

  job->renderer = Ref<Renderer>(new Sprinkler);
  job->renderer->samples = 4;
  job->render();
  const std::string text = fireflies_text(*job, "c");
  EXPECT_TRUE(has(text, "splatted at (2.50, 3.25), ")) << text;
  const double value = job->image->develop().at(0, 0, 1);
  const std::vector<LargeSample> largest = job->image->largest_samples();
  ASSERT_EQ(listed_in(text).size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    const Listed l = listed_in(text)[i];
    EXPECT_TRUE(largest[i].splat);
    EXPECT_NEAR(l.ratio, l.luminance / value, 1e-3 * l.ratio);
    EXPECT_DOUBLE_EQ(replay_sample(*job, l.x, l.y, l.sample).paths[0].splatted, largest[i].luminance);
  }
  // All splats of the picture, each a 4th of what it counts for, make the pixel they all fall into.
  double sum = 0, own = 0;
  std::uint64_t bad = 0;
  for (int y = 3; y < 13; ++y)
    for (int x = 2; x < 12; ++x)
      for (const ReplayedPath& path : replay_pixel(*job, x, y, 4).paths) {
        sum += path.splatted / 4;
        bad += path.bad;
        if (x == 2 && y == 3) own += path.luminance / 4;
      }
  EXPECT_NEAR(sum + own, value, 1e-6 * value);
  EXPECT_EQ(bad, job->image->bad_samples());
  EXPECT_GT(bad, 0u);
}

TEST(Fireflies, a_black_picture_has_none) {
  const Ref<Job> job = prepared(test::job_text("PathTracer { samples: 2 }", camera, 4, floor_disc));
  job->image->keep_largest(3);
  job->render();
  EXPECT_EQ(fireflies_text(*job, "c"), "No sample brought any light.\n");
}

// ---- advice -------------------------------------------------------------------------------------------------------------

TEST(AdviceText, names_what_can) {
  EXPECT_EQ(advice_text("A", {"x", "PathTracer"}), "A cannot find x; PathTracer can");
  EXPECT_EQ(advice_text("A", {"x", "PathTracer, NoSuchRenderer"}), "A cannot find x; PathTracer can");
  EXPECT_EQ(advice_text("A", {"x", "PathTracer or PathTracer"}), "A cannot find x; PathTracer and PathTracer can");
  EXPECT_EQ(advice_text("A", {"x", "NoSuchRenderer, Sphere"}), "A cannot find x; no known renderer can");
  EXPECT_EQ(advice_text("A", {"x", "set next_event: true"}), "A cannot find x; set next_event: true");
  EXPECT_EQ(advice_text("A", {"x", "PathTracer { next_event: true }"}), "A cannot find x; PathTracer { next_event: true } can");
  EXPECT_EQ(advice_text("A", {"x", ""}), "A cannot find x; no known renderer can");
}

const char* const lamp_and_ball = R"(lamp = Point { position: [1, 3, 0] m, emission: DiffuseEmission { radiance: 20 } }
ball = Sphere { radius: 1 m, shader: Dielectric { ior: 1.5 } }
)";

std::string point_scene(const std::string& renderer, const std::vector<std::string>& parts) {
  return lamp_and_ball + test::job_text(renderer, camera, 4, objects(parts));
}

TEST(AdviceText, a_path_tracer_loses_caustics_of_a_point_light_through_glass) {
  const Ref<Job> job = prepared(point_scene("PathTracer {}", {floor_disc, "lamp", "ball"}));
  const std::vector<std::string> lines = advice_lines(*job);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].starts_with("PathTracer cannot find ")) << lines[0];
  for (const char* part : {"caustics", "'lamp'", "'ball'"}) EXPECT_TRUE(has(lines[0], part)) << lines[0];
  EXPECT_TRUE(has(lines[0], "; BidirectionalPathTracer") && lines[0].ends_with(" can")) << lines[0];
  const SceneTraits traits = scene_traits(*job->scene, *job->camera);
  for (const std::string& name : renderers_that_find_all(traits)) {
    EXPECT_NE(name, "PathTracer");
    EXPECT_NE(name, "Renderer") << "an interface is no renderer";
  }
  EXPECT_EQ(luminaires_text(traits), "1: 1 point light");
}

TEST(AdviceText, without_next_event_a_path_tracer_loses_lights_without_extent) {
  const Ref<Job> job = prepared(point_scene("PathTracer { next_event: false }", {floor_disc, "lamp", "ball"}));
  const std::vector<std::string> lines = advice_lines(*job);
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(has(lines[0], "'lamp'") && has(lines[0], "next_event")) << lines[0];
}

TEST(AdviceText, a_path_tracer_finds_the_light_of_other_scenes) {
  const std::string only_lamp = R"(Point { position: [1, 3, 0] m, emission: DiffuseEmission { radiance: 20 } })";
  for (const std::vector<std::string>& parts :
       {std::vector<std::string>{floor_disc, glass_ball, round_lamp}, std::vector<std::string>{floor_disc, only_lamp},
        std::vector<std::string>{glass_ball, "Environment { emission: DiffuseEmission {} }"},
        std::vector<std::string>{floor_disc}}) {
    const Ref<Job> job = prepared(test::job_text("PathTracer {}", camera, 4, objects(parts)));
    for (const std::string& line : advice_lines(*job)) ADD_FAILURE() << line;
    const std::vector<std::string> all = renderers_that_find_all(scene_traits(*job->scene, *job->camera));
    EXPECT_TRUE(std::find(all.begin(), all.end(), "PathTracer") != all.end());
  }
}

TEST(AdviceText, whitted_ray_tracing_loses_the_light_of_lamps_with_an_area) {
  const Ref<Job> job = prepared(test::job_text("WhittedRenderer {}", camera, 4, objects({floor_disc, round_lamp})));
  const std::vector<std::string> lines = advice_lines(*job);
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines[0].starts_with("WhittedRenderer cannot find light of the Sphere of line ")) << lines[0];
  EXPECT_TRUE(has(lines[0], "PathTracer")) << lines[0];
  const std::vector<std::string> all = renderers_that_find_all(scene_traits(*job->scene, *job->camera));
  EXPECT_TRUE(std::find(all.begin(), all.end(), "PathTracer") != all.end());
  EXPECT_TRUE(std::find(all.begin(), all.end(), "WhittedRenderer") == all.end());
}

TEST(AdviceText, luminaires_are_counted_by_kind) {
  const Ref<Job> job = prepared(test::job_text(
      "PathTracer {}", camera, 4,
      objects({floor_disc, round_lamp, round_lamp, "Environment { emission: DiffuseEmission {} }",
               std::string("BruteForceScene { objects: [ ") + round_lamp + " ] }", "Point { emission: DiffuseEmission {} }"})));
  EXPECT_EQ(luminaires_text(scene_traits(*job->scene, *job->camera)),
            "5: 1 point light, 2 area lights, 1 environment, 1 in a nested scene");
}

// ---- the program --------------------------------------------------------------------------------------------------------

class ReplayProgram : public testing::Test {
 protected:
  /// Runs the program to its end in the test's folder.
  int run(const std::vector<std::string>& arguments) {
    Process process(program, arguments, folder);
    const int status = process.wait();
    out = process.out();
    err = process.err();
    return status;
  }
  /// Runs a command line as it was printed, with further options.
  int run_printed(const std::string& command, const std::vector<std::string>& more = {}) {
    std::istringstream words(command);
    std::string word;
    words >> word;
    EXPECT_EQ(word, "etendue");
    std::vector<std::string> arguments;
    while (words >> word) arguments.push_back(word);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  nlohmann::json replayed(const std::string& name) const { return nlohmann::json::parse(file_text(folder / name)); }
  void SetUp() override {
    scene = folder.write("glass.etd", glass_text(16));
    caustic = folder.write("caustic.etd", point_scene("PathTracer { samples: 1 }", {floor_disc, "lamp", "ball"}));
  }

  const std::string program = ETENDUE_BINARY_DIR "/etendue";
  TemporaryFolder folder;
  std::string scene, caustic, out, err;
};

TEST_F(ReplayProgram, the_command_of_a_path_replays_it_alone) {
  ASSERT_EQ(run({"render", scene, "--seed", "5", "--pixel", "6,10", "--replay", "a.json"}), 0) << err;
  for (const char* part : {"pixel 6,10: 16 samples", "of its pixel's light", "vertex 0: camera", "contributions", "X Y Z"})
    EXPECT_TRUE(has(out, part)) << part << " is not in\n" << out;
  const auto pixel = replayed("a.json");
  EXPECT_EQ(pixel["seed"], 5);
  EXPECT_EQ(pixel["file"], scene);
  ASSERT_EQ(pixel["paths"].size(), 5u);  // by default
  const auto& path = pixel["paths"][1];
  EXPECT_TRUE(has(out, path["command"].get<std::string>() + "\n"));
  ASSERT_EQ(run_printed(path["command"], {"--replay", "b.json"}), 0) << err;
  const auto alone = replayed("b.json")["paths"];
  ASSERT_EQ(alone.size(), 1u);
  for (const char* member : {"sample", "film", "wavelengths", "result", "luminance", "vertices", "contributions"})
    EXPECT_EQ(alone[0][member], path[member]) << member;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_FALSE(has(entry.path().filename().string(), "part")) << entry.path();
}

TEST_F(ReplayProgram, the_command_of_a_firefly_replays_it_alone) {
  ASSERT_EQ(run({"render", scene, "--samples", "8", "--fireflies", "3", "-o", "a.npy"}), 0) << err;
  const std::vector<Listed> list = listed_in(out);
  ASSERT_EQ(list.size(), 3u) << out;
  const size_t from = out.find("  etendue render") + 2;
  const std::string command = out.substr(from, out.find("    #", from) - from);
  ASSERT_EQ(run_printed(command, {"--replay", "b.json"}), 0) << err;
  EXPECT_NEAR(replayed("b.json")["paths"][0]["luminance"].get<double>(), list[0].luminance, 1e-5 * list[0].luminance);
}

TEST_F(ReplayProgram, check_and_render_warn_of_lost_light) {
  ASSERT_EQ(run({"check", caustic}), 0) << err;
  EXPECT_TRUE(has(err, "warning: PathTracer cannot find ") && has(err, "'lamp'")) << err;
  EXPECT_TRUE(has(out, "luminaires  1: 1 point light\n")) << out;
  ASSERT_EQ(run({"render", caustic, "--quiet", "-o", "a.npy"}), 0) << err;
  EXPECT_TRUE(has(err, "warning: PathTracer cannot find ")) << err;
  ASSERT_EQ(run({"check", scene}), 0) << err;
  EXPECT_EQ(err, "");
  const size_t at = out.find("renderers that find all light of this scene: ");
  ASSERT_NE(at, std::string::npos) << out;
  EXPECT_TRUE(has(out.substr(at, out.find('\n', at) - at), "PathTracer")) << out;
}

TEST_F(ReplayProgram, wrong_usage_is_refused) {
  const std::vector<std::vector<std::string>> wrong = {
      {"--sample", "3"},
      {"--replay", "a.json"},
      {"--pixel", "1,1", "--paths", "0"},
      {"--pixel", "1,1", "--replay", "no/such/a.json"},
  };
  for (const auto& options : wrong) {
    std::vector<std::string> arguments{"render", scene};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run(arguments), 2) << testing::PrintToString(options);
    EXPECT_FALSE(err.empty()) << testing::PrintToString(options);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.json"));
}

}  // namespace
}  // namespace etendue
