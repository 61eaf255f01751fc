// scenes/cornell_box.etd against the same box in Mitsuba 3 (llvm_ad_spectral): means of 32 x 32 pixel tiles.

#include <gtest/gtest.h>

#include "support/cornell_reference.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

TEST(CornellBox, AgreesWithMitsuba) {
  // The size and the angle of view of the reference.
  const Ref<Job> job =
      load_job(ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd", {.defines = {{"size", "256"}, {"fov", "39.3077 deg"}}});
  job->renderer->samples = 128;
  const auto render = rendered(job);
  EXPECT_EQ(render->film().bad_samples(), 0u);
  const Image image = render->picture();
  ASSERT_EQ(image.width, 256);
  ASSERT_EQ(image.height, 256);
  double whole[3] = {}, reference[3] = {};
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 8; ++column)
      for (size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (int y = 0; y < 32; ++y)
          for (int x = 0; x < 32; ++x) sum += image.at(32 * column + x, 32 * row + y, c);
        const double expected = cornell_reference[row][column][c];
        whole[c] += sum / (64 * 1024);
        reference[c] += expected / 64;
        // Corner tiles have only a few lit pixels; 128 samples leave up to 1 % of noise in Z, and the reference has half of
        // that.
        EXPECT_NEAR(sum / 1024 / expected, 1, 0.025) << "tile " << column << ", " << row << ", channel " << c;
      }
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(whole[c] / reference[c], 1, 0.003) << "channel " << c;
}

}  // namespace
}  // namespace etendue::test
