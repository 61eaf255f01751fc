// The program: `render --pixel --sample --replay` and `--fireflies`, and warnings of light that is not found.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/program_support.h"
#include "support/replay_test_support.h"

namespace etendue::replay_test {
namespace {

class ReplayProgram : public RunsProgram {
 protected:
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

  std::string scene, caustic;
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
}  // namespace etendue::replay_test
