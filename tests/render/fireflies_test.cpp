// The samples that brought most light.

#include "app/fireflies.h"

#include <gtest/gtest.h>

#include "app/replay.h"
#include "support/replay_test_support.h"

namespace etendue::replay_test {
namespace {

TEST(Fireflies, those_listed_are_the_brightest_and_replay_to_the_same) {
  const Ref<Job> job = prepared(glass_text(8));
  job->film().keep_largest(5);
  job->render();
  const std::string text = fireflies_text(*job, "etendue render a.etd -D n=1");
  const std::vector<Listed> list = listed_in(text);
  ASSERT_EQ(list.size(), 5u) << text;
  EXPECT_TRUE(has(text, "  etendue render a.etd -D n=1 --pixel ")) << text;
  const Image picture = job->picture();
  const std::vector<LargeSample> largest = job->film().largest_samples();
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
  job->film().keep_largest(3);
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
  const double value = job->film().develop().at(0, 0, 1);
  const std::vector<LargeSample> largest = job->film().largest_samples();
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
  EXPECT_EQ(bad, job->film().bad_samples());
  EXPECT_GT(bad, 0u);
}

TEST(Fireflies, a_black_picture_has_none) {
  const Ref<Job> job = prepared(test::job_text("PathTracer { samples: 2 }", camera, 4, floor_disc));
  job->film().keep_largest(3);
  job->render();
  EXPECT_EQ(fireflies_text(*job, "c"), "No sample brought any light.\n");
}

}  // namespace
}  // namespace etendue::replay_test
