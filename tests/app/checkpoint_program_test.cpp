// Checkpoints of the program: renders that are interrupted, killed and continued, and parts that are merged.

#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "support/checkpoint_test_support.h"

namespace etendue::checkpoint_test {
namespace {

class CheckpointProgramTest : public CheckpointTest {
 protected:
  /// `render scene --samples n --quiet` and more.
  std::vector<std::string> rendering(const std::string& samples, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"render", "scene.etd", "--samples", samples, "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  void SetUp() override { folder.write("scene.etd", ball_text()); }
  bool same_files(const std::string& a, const std::string& b) const {
    const std::string bytes = file_text(folder / a);
    return !bytes.empty() && bytes == file_text(folder / b);
  }
};

TEST_F(CheckpointProgramTest, continues_and_merges) {
  const std::string samples = std::to_string(3 * step + 5);
  const std::vector<std::string> outputs = {"-o", "one.npy", "-o", "one.exr", "-o", "one.png"};
  ASSERT_EQ(run(rendering(samples, outputs)), 0) << err;

  ASSERT_EQ(run({"render", "scene.etd", "--samples", samples, "--passes", "0:2", "--checkpoint", "a"}), 0) << err;
  EXPECT_TRUE(has(out, "passes 0:2 of 0:4, 16384 samples per pixel each")) << out;
  EXPECT_FALSE(std::filesystem::exists(folder / "scene.png"));
  std::filesystem::copy_file(folder / "a", folder / "b");
  std::vector<std::string> again = outputs;
  for (std::string& name : again)
    if (name != "-o") name.replace(0, 3, "two");
  again.insert(again.end(), {"--resume", "b"});
  ASSERT_EQ(run(rendering(samples, again)), 0) << err;
  for (const char* ending : {".npy", ".exr", ".png"})
    EXPECT_TRUE(same_files(std::string("one") + ending, std::string("two") + ending)) << ending;
  // The checkpoint now holds the whole render: continuing from it changes nothing, and --continue works like --resume.
  EXPECT_EQ(read_checkpoint(folder / "b").done, (std::vector<IndexRange>{{0, 3 * step + 5}}));
  ASSERT_EQ(run(rendering(samples, {"--continue", "b", "-o", "two.npy"})), 0) << err;
  EXPECT_TRUE(same_files("one.npy", "two.npy"));
  ASSERT_EQ(run(rendering(samples, {"--continue", "c", "--passes", "3:4"})), 0) << err;
  ASSERT_EQ(run(rendering(samples, {"--continue", "c", "--passes", "3:4", "-o", "part.npy"})), 0) << err;
  EXPECT_FALSE(same_files("one.npy", "part.npy"));

  ASSERT_EQ(run({"image", "merge", "c", "a", "-o", "gap.npy", "--checkpoint", "ac"}), 0) << err;
  EXPECT_TRUE(has(err, "note: samples 32768 to 49151 (--passes 2:3)")) << err;
  EXPECT_TRUE(has(out, "32773 samples per pixel of 2 parts")) << out;
  ASSERT_EQ(run(rendering(samples, {"--passes", "2:3", "--checkpoint", "d"})), 0) << err;
  // Without -o the picture is written where the description says: here to a PNG named after the description.
  ASSERT_EQ(run({"image", "merge", "d", "ac"}), 0) << err;
  EXPECT_EQ(err, "");
  EXPECT_TRUE(has(out, "scene.png\n")) << out;
  EXPECT_TRUE(same_files("one.png", "scene.png"));
  ASSERT_EQ(run({"image", "merge", "d", "ac", "-o", "merged.npy", "-o", "merged.exr"}), 0) << err;
  ASSERT_EQ(run({"image", "diff", "one.npy", "merged.npy", "--tolerance", "1e-12"}), 0) << out;
  ASSERT_EQ(run({"image", "info", "merged.exr"}), 0);
  EXPECT_TRUE(has(out, "samples: " + samples)) << out;
  EXPECT_EQ(run({"image", "merge", "a", "ac", "-o", "x.npy"}), 2);
  EXPECT_TRUE(has(err, "both hold samples 0 to 32767")) << err;
  EXPECT_EQ(run({"image", "merge", "scene.etd", "-o", "x.npy"}), 2);
  EXPECT_EQ(run({"image", "merge", "a", "-o", "x.nothing"}), 2);
  EXPECT_EQ(run({"image", "merge"}), 2);
}

TEST_F(CheckpointProgramTest, wrong_requests_are_explained) {
  const std::string samples = std::to_string(2 * step);
  ASSERT_EQ(run(rendering(samples, {"--passes", "0:1", "--checkpoint", "a"})), 0) << err;
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"--passes", "0:1"}, "--checkpoint"},
      {{"--passes", "0:3", "--checkpoint", "b"}, "are 2 passes of 16384"},
      {{"--passes", "1:1", "--checkpoint", "b"}, "not a range of passes"},
      {{"--passes", "a:b", "--checkpoint", "b"}, "A:B"},
      {{"--every", "5s"}, "--checkpoint"},
      {{"--resume", "absent"}, "there is no such file"},
      {{"--resume", "scene.etd"}, "it is not a checkpoint"},
      {{"--resume", "a", "--continue", "a"}, "--continue"},
      {{"--resume", "a", "--seed", "4"}, "the seed differs"},
      {{"--resume", "a", "--size", "3x1"}, "the description differs"},
      {{"--resume", "a", "--samples", "100"}, "only 100 are wanted"},
      {{"--checkpoint", "no/such/b"}, "there is no folder"},
      {{"--checkpoint", "b", "--pixel", "0,0", "--sample", "0"}, "--pixel"},
  };
  for (const auto& [options, reason] : wrong) {
    std::vector<std::string> arguments{"render", "scene.etd", "--quiet"};
    if (options.back() != "100") arguments.insert(arguments.end(), {"--samples", samples});
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run(arguments), 2) << options[0] << " " << options[1] << "\n" << err;
    EXPECT_TRUE(has(err, reason)) << options[0] << " " << options[1] << "\n" << err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "b"));
}

TEST_F(CheckpointProgramTest, an_interrupted_render_says_how_to_go_on) {
  const std::string samples = std::to_string(400 * step);
  {
    Process process(program,
                    {"render", "scene.etd", "--samples", samples, "--checkpoint", "state", "--set", "camera.fov=41", "-o",
                     "a.npy", "--progress", "bar"},
                    folder);
    for (int i = 0; i < 6000 && process.err().empty(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    process.send(SIGTERM);
    ASSERT_EQ(process.wait(), 130) << process.err();
    EXPECT_TRUE(has(process.out(), "to resume: etendue render scene.etd --set camera.fov=41 --samples " + samples +
                                       " -o a.npy --resume state\n"))
        << process.out();
  }
  EXPECT_LT(count(read_checkpoint(folder / "state").done), 400u * step);
  ASSERT_EQ(run(rendering(samples, {"--set", "camera.fov=41", "--resume", "state", "-o", "a.npy"})), 0) << err;
  ASSERT_EQ(run(rendering(samples, {"--set", "camera.fov=41", "-o", "b.npy"})), 0) << err;
  EXPECT_TRUE(same_files("a.npy", "b.npy"));
}

/// The environment variable ETENDUE_KILLS sets the number of kills; 5 if it is not set.
TEST_F(CheckpointProgramTest, killed_at_any_moment_it_goes_on_to_the_same_bits) {
  const char* asked = std::getenv("ETENDUE_KILLS");
  const int kills = asked ? std::atoi(asked) : 5;
  const std::string samples = std::to_string(40 * step + 3000);
  const auto seconds = [&](const std::vector<std::string>& arguments) {
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_EQ(run(arguments), 0) << err;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  };
  const double start = seconds({"check", "scene.etd"});
  const double whole = seconds(rendering(samples, {"-o", "one.npy", "-o", "one.exr", "-o", "one.png"}));

  const std::vector<std::string> arguments =
      rendering(samples, {"-o", "two.npy", "-o", "two.exr", "-o", "two.png", "--continue", "state", "--every", "0s"});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> delay(0.5 * start, 0.8 * start + 0.4 * whole);
  int killed = 0, with_state = 0;
  // Without a written state a restart could not differ: some of the kills must come after the state was first written.
  for (int tries = 0; killed < kills && tries < 20 * kills; ++tries) {
    Process process(program, arguments, folder);
    std::this_thread::sleep_for(std::chrono::duration<double>(delay(random)));
    process.send(SIGKILL);
    const bool was_killed = process.wait() == 128 + SIGKILL;
    killed += was_killed;
    const bool state = std::filesystem::exists(folder / "state");
    with_state += was_killed && state;
    if (state) {
      EXPECT_EQ(complaint([&] { read_checkpoint(folder / "state"); }), "");
    }
    if (was_killed) continue;
    // The render finished before the kill; the next one starts from the beginning.
    EXPECT_TRUE(same_files("one.npy", "two.npy"));
    std::filesystem::remove(folder / "state");
  }
  EXPECT_EQ(killed, kills);
  EXPECT_GE(with_state, 1);
  ASSERT_EQ(run(arguments), 0) << err;
  for (const char* ending : {".npy", ".exr", ".png"})
    EXPECT_TRUE(same_files(std::string("one") + ending, std::string("two") + ending)) << ending;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_FALSE(has(entry.path().filename().string(), ".state.part")) << entry.path();
}

}  // namespace
}  // namespace etendue::checkpoint_test
