// Partial renders that are merged in any order have the bytes of a single render.

#include <gtest/gtest.h>

#include <random>

#include "support/checkpoint_test_support.h"

namespace etendue::checkpoint_test {
namespace {

/// With an image of more than 2^18 pixels, a step has one sample of each.
constexpr const char* image =
    "width: 521, height: 504, path_lengths: 3, "
    "layers: [\"albedo\", \"normal\", \"depth\", \"object\", \"variance\", \"samples\"]";

Ref<Job> ball_job(const std::string& renderer, const std::string& crop, int samples) {
  std::string text = ball_text(renderer + " { max_depth: 3 }", std::string(image) + crop);
  text.replace(text.find("height: 1, "), 11, "");
  return job_of(text, samples);
}

bool same_picture(const Image& a, const Image& b) { return a.channels == b.channels && a.values == b.values; }

class MergeOrderTest : public CheckpointTest {
 protected:
  /// Renders the parts, and expects that merging them, in three orders and also two at a time, equals a single render.
  void expect_same_in_any_order(const std::string& renderer, const std::string& crop, const std::vector<IndexRange>& passes,
                                int samples) {
    SCOPED_TRACE(renderer + crop);
    const auto straight = rendered(ball_job(renderer, crop, samples), two_threads);
    std::vector<std::string> files;
    for (const IndexRange& range : passes)
      files.push_back(part(ball_job(renderer, crop, samples), "part" + std::to_string(range.begin), range));
    std::mt19937 random(11);
    for (int order = 0; order < 3; ++order) {
      std::ranges::shuffle(files, random);
      // merge_checkpoints sorts its arguments, so film states are also added directly in this order.
      Film sum(*straight->job().image);
      for (const std::string& file : files) sum.add_state(read_checkpoint(file).state.image);
      EXPECT_TRUE(sum.save_state() == film(*straight));
      EXPECT_TRUE(same_picture(sum.develop(), straight->film().develop()));
      write_checkpoint(merge_checkpoints({files[0], files[1]}), folder / "two");
      std::vector<std::string> rest(files.begin() + 2, files.end());
      rest.push_back(folder / "two");
      expect_same(merge_checkpoints(rest), *straight);
    }
  }

  const std::vector<IndexRange> eight = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 7}, {7, 8}};
};

TEST_F(MergeOrderTest, path_tracer) { expect_same_in_any_order("PathTracer", "", eight, 8); }
TEST_F(MergeOrderTest, light_tracer) { expect_same_in_any_order("LightTracer", "", eight, 8); }
TEST_F(MergeOrderTest, bidirectional_path_tracer) { expect_same_in_any_order("BidirectionalPathTracer", "", eight, 8); }

// A crop has fewer pixels, so its steps have several samples of each; the last step is short.
TEST_F(MergeOrderTest, crops) {
  for (const char* renderer : {"PathTracer", "BidirectionalPathTracer"})
    expect_same_in_any_order(renderer, ", crop: [230, 200, 330, 290]", {{0, 1}, {1, 2}, {2, 4}, {4, 5}}, 4 * 32 + 5);
}

}  // namespace
}  // namespace etendue::checkpoint_test
