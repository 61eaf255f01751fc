// Replay: samples that are computed again.

#include "check/replay/replay.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "support/replay_test_support.h"

namespace etendue::replay_test {
namespace {

TEST(Replay, json_tells_where_all_light_of_a_pixel_comes_from) {
  const Render render(loaded(glass_text(64)));
  const PixelReplay replay = replay_pixel(render, px, py, 64);
  const auto json = nlohmann::json::parse(replay_json(render.job(), replay, "test.etd", "etendue render test.etd"));
  EXPECT_EQ(json["file"], "test.etd");
  EXPECT_EQ(json["renderer"], "PathTracer");
  EXPECT_EQ(json["seed"], 0);
  EXPECT_EQ(json["pixel"], nlohmann::json({px, py}));
  EXPECT_EQ(json["samples"], 64);
  ASSERT_EQ(json["paths"].size(), 64u);

  double shares = 0, sum = 0, before = std::numeric_limits<double>::infinity();
  int lit = 0, several = 0, dispersed = 0;
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
    EXPECT_FALSE(path["single"].get<bool>()) << "the light of each wavelength that was followed is in its place";
    bool disperses = false;
    for (const auto& v : path["vertices"])
      disperses |= v.contains("note") && v["note"].get<std::string>().starts_with("dispersion");
    dispersed += disperses;
  }
  EXPECT_NEAR(shares, 1, 1e-9);
  EXPECT_EQ(samples.size(), 64u) << "each sample once";
  EXPECT_NEAR(sum / 64, json["luminance"].get<double>(), 1e-9 * sum);
  EXPECT_GT(lit, 32);
  EXPECT_GT(several, 8);
  EXPECT_GT(dispersed, 8);
}

TEST(Replay, a_pixel_is_what_the_picture_has_there) {
  Render render(loaded(glass_text(48)));
  const PixelReplay replay = replay_pixel(render, px, py, 1);
  ASSERT_TRUE(replay.luminance);
  render.run();
  const double in_picture = render.picture().at(px, py, 1);
  EXPECT_GT(in_picture, 0);
  EXPECT_NEAR(*replay.luminance, in_picture, 1e-9 * in_picture);
}

TEST(Replay, the_brightest_are_the_same_however_many_are_asked_for_and_on_any_number_of_threads) {
  const Ref<Job> job = loaded(glass_text(3000));  // several work items
  const PixelReplay many = replay_pixel(Render(job, {.threads = 1}), px, py, 3000);
  ASSERT_EQ(many.paths.size(), 3000u);
  for (const int threads : {1, 2, 5}) {
    const PixelReplay few = replay_pixel(Render(job, {.threads = threads}), px, py, 4);
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
  const Render render(loaded(glass_text(16)));
  const PixelReplay all = replay_pixel(render, px, py, 16);
  const PixelReplay one = replay_sample(render, px, py, all.paths[0].sample);
  ASSERT_EQ(one.paths.size(), 1u);
  EXPECT_EQ(one.paths[0].luminance, all.paths[0].luminance);
  EXPECT_EQ(one.paths[0].record.contributions.size(), all.paths[0].record.contributions.size());
  EXPECT_FALSE(one.paths[0].share);
  const auto json = nlohmann::json::parse(replay_json(render.job(), one, "a.etd", "etendue render a.etd"));
  EXPECT_TRUE(json["luminance"].is_null());
  EXPECT_TRUE(json["paths"][0]["share"].is_null());
  EXPECT_FALSE(has(replay_text(one, "c"), "is not in it"));
  EXPECT_TRUE(has(replay_text(replay_sample(render, px, py, 16), "c"), "samples 0 to 15; this one is not in it"));
  EXPECT_THROW(replay_sample(render, 16, 0, 0), Error);
  EXPECT_THROW(replay_pixel(render, 0, -1, 1), Error);
}

TEST(Replay, a_black_pixel_has_no_shares) {
  const Render render(loaded(test::job_text("PathTracer { samples: 4 }", camera, 16, floor_disc)));
  const PixelReplay replay = replay_pixel(render, px, py, 5);
  EXPECT_EQ(*replay.luminance, 0);
  ASSERT_EQ(replay.paths.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(replay.paths[i].sample, i);
    EXPECT_FALSE(replay.paths[i].share);
  }
}

// ---- splats and bad samples ---------------------------------------------------------------------------------------------

TEST(Replay, splats_and_bad_samples_are_told) {
  const Render render(sprinkled(glass_text(64), 64));
  const PixelReplay replay = replay_pixel(render, px, py, 64);
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

  const auto json = nlohmann::json::parse(replay_json(render.job(), replay, "a.etd", "etendue render a.etd"));
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

}  // namespace
}  // namespace etendue::replay_test
