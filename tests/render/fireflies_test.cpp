// Fireflies: the list of the brightest samples.

#include "app/fireflies.h"

#include <gtest/gtest.h>

#include "check/replay/replay.h"
#include "support/replay_test_support.h"

namespace etendue::replay_test {
namespace {

/// A render with all its samples, whose film stores the brightest ones.
std::unique_ptr<Render> rendered_keeping(size_t largest, const Ref<Job>& job) {
  auto render = std::make_unique<Render>(job);
  render->film().keep_largest(largest);
  EXPECT_EQ(render->run(), Ended::samples);
  return render;
}

TEST(Fireflies, those_listed_are_the_brightest_and_replay_to_the_same) {
  const auto render = rendered_keeping(5, loaded(glass_text(8)));
  const std::string text = fireflies_text(*render, "etendue render a.etd -D n=1");
  const std::vector<Listed> list = listed_in(text);
  ASSERT_EQ(list.size(), 5u) << text;
  EXPECT_TRUE(has(text, "  etendue render a.etd -D n=1 --pixel ")) << text;
  const Image picture = render->picture();
  const std::vector<LargeSample> largest = render->film().largest_samples();
  for (size_t i = 0; i < list.size(); ++i) {
    const Listed& l = list[i];
    if (i > 0) {
      EXPECT_LE(l.luminance, list[i - 1].luminance);
    }
    const PixelReplay replay = replay_sample(*render, l.x, l.y, l.sample);
    EXPECT_DOUBLE_EQ(replay.paths[0].luminance, largest[i].luminance);
    EXPECT_NEAR(replay.paths[0].luminance, l.luminance, 1e-5 * l.luminance);
    EXPECT_NEAR(l.ratio, l.luminance / picture.at(l.x, l.y, 1), 1e-3 * l.ratio);
  }
  double brightest = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) brightest = std::max(brightest, replay_pixel(*render, x, y, 1).paths[0].luminance);
  EXPECT_DOUBLE_EQ(brightest, largest[0].luminance);
}

TEST(Fireflies, places_in_a_crop_and_of_splats) {
  const auto rendered_crop = [](const Ref<Job>& job) {
    job->image->crop = {2, 3, 12, 13};
    return rendered_keeping(3, job);
  };
  const auto traced = rendered_crop(loaded(glass_text(8)));
  const Image picture = traced->picture();
  const std::vector<Listed> list = listed_in(fireflies_text(*traced, "c"));
  ASSERT_EQ(list.size(), 3u);
  for (const Listed& l : list) EXPECT_NEAR(l.ratio, l.luminance / picture.at(l.x - 2, l.y - 3, 1), 1e-3 * l.ratio);

  const auto render = rendered_crop(sprinkled(glass_text(8), 4));
  const std::string text = fireflies_text(*render, "c");
  EXPECT_TRUE(has(text, "splatted at (2.50, 3.25), ")) << text;
  const double value = render->film().develop().at(0, 0, 1);
  const std::vector<LargeSample> largest = render->film().largest_samples();
  ASSERT_EQ(listed_in(text).size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    const Listed l = listed_in(text)[i];
    EXPECT_TRUE(largest[i].splat);
    EXPECT_NEAR(l.ratio, l.luminance / value, 1e-3 * l.ratio);
    EXPECT_DOUBLE_EQ(replay_sample(*render, l.x, l.y, l.sample).paths[0].splatted, largest[i].luminance);
  }
  // All splats of the image fall into one pixel, whose value is their sum over 4 samples.
  double sum = 0, own = 0;
  std::uint64_t bad = 0;
  for (int y = 3; y < 13; ++y)
    for (int x = 2; x < 12; ++x)
      for (const ReplayedPath& path : replay_pixel(*render, x, y, 4).paths) {
        sum += path.splatted / 4;
        bad += path.bad;
        if (x == 2 && y == 3) own += path.luminance / 4;
      }
  EXPECT_NEAR(sum + own, value, 1e-6 * value);
  EXPECT_EQ(bad, render->film().bad_samples());
  EXPECT_GT(bad, 0u);
}

TEST(Fireflies, no_command_is_given_that_would_be_refused) {
  std::string text = glass_text(8);
  text.replace(text.find("PathTracer {"), 12, "AdaptiveSampling { inner: PathTracer {},");
  const auto render = rendered_keeping(3, loaded(text));
  const std::string told = fireflies_text(*render, "etendue render a.etd");
  EXPECT_FALSE(has(told, "--pixel")) << told;
  EXPECT_TRUE(has(told, "AdaptiveSampling")) << told;
  const LargeSample brightest = render->film().largest_samples()[0];
  EXPECT_TRUE(has(told, "  pixel " + std::to_string(brightest.x) + "," + std::to_string(brightest.y) + " # Y ")) << told;
  EXPECT_THROW(replay_sample(*render, brightest.x, brightest.y, brightest.sample), Error);
}

TEST(Fireflies, a_black_picture_has_none) {
  const std::string text = test::job_text("PathTracer { samples: 2 }", camera, 4, floor_disc);
  EXPECT_EQ(fireflies_text(*rendered_keeping(3, loaded(text)), "c"), "All samples are black.\n");
}

}  // namespace
}  // namespace etendue::replay_test
