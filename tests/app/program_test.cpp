// The command line program, run as users run it.

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "support/program_support.h"

namespace etendue {
namespace {

const char* const tiny_scene = R"(# A grey ball below a lamp.
param samples = 4
param depth = 4
Job {
    seed: 7
    renderer: PathTracer { max_depth: depth, samples: samples }
    camera:   PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 45 deg }
    image:    ImageBuffer { width: 24, height: 16, filter: BoxFilter {} }
    scene:    EmbreeScene { objects: [
        Sphere { radius: 1 m, shader: Lambertian { color: 0.5 } },
        Sphere { radius: 0.5 m, transform: translate(0, 2 m, -1 m), emission: DiffuseEmission { radiance: 5 } },
    ] }
}
)";

class ProgramTest : public RunsProgram {
 protected:
  void SetUp() override { scene = folder.write("tiny.etd", tiny_scene); }

  std::string scene;
};

/// The doubles of an NPY file behind its header.
std::vector<double> npy_values(const std::string& path) {
  const std::string bytes = file_text(path);
  if (bytes.size() < 10) return {};
  const size_t header = 10 + size_t(static_cast<unsigned char>(bytes[8])) + 256 * size_t(static_cast<unsigned char>(bytes[9]));
  std::vector<double> values((bytes.size() - header) / sizeof(double));
  std::memcpy(values.data(), bytes.data() + header, values.size() * sizeof(double));
  return values;
}

// ---- help and usage ---------------------------------------------------------------------------------------------------

TEST_F(ProgramTest, help_teaches) {
  EXPECT_EQ(run({"--help"}), 0);
  for (const char* word :
       {"render", "check", "save", "classes", "schema", "manual", "image", "First steps", "cornell_box.etd", "Exit status"})
    EXPECT_TRUE(has(out, word)) << word;
  for (const char* command : {"render", "check", "save", "classes", "schema", "manual", "image"}) {
    EXPECT_EQ(run({command, "--help"}), 0) << command;
    EXPECT_TRUE(has(out, command));
    EXPECT_EQ(err, "");
  }
  EXPECT_EQ(run({"render", "--help"}), 0);
  for (const char* option : {"--output", "--define", "--set", "--samples", "--time", "--error", "--seed", "--threads", "--size",
                             "--crop", "--quiet", "--progress", "--plugin", "--pixel", "--sample"})
    EXPECT_TRUE(has(out, option)) << option;
}

TEST_F(ProgramTest, version) {
  EXPECT_EQ(run({"--version"}), 0);
  EXPECT_EQ(out, "etendue " ETENDUE_VERSION "\n");
}

TEST_F(ProgramTest, wrong_usage_exits_with_2_and_says_why) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({"rendr", scene}), 2);
  EXPECT_TRUE(has(err, "did you mean 'render'")) << err;
  EXPECT_EQ(run({"render"}), 2);
  EXPECT_TRUE(has(err, "FILE")) << err;
  EXPECT_EQ(run({"render", scene, "--sampels", "4"}), 2);
  EXPECT_TRUE(has(err, "did you mean '--samples'")) << err;
  const std::vector<std::vector<std::string>> wrong = {
      {"--threads", "many"}, {"--threads", "-1"}, {"--progress", "dots"},  {"--size", "64"},    {"--size", "64x"},
      {"--crop", "1,2,3"},   {"--time", "soon"},  {"--time", "5m5m"},      {"--time", "-3"},    {"--samples", "few"},
      {"--samples", "-2"},   {"--seed", "-1"},    {"--sample", "3"},       {"-D", "samples"},   {"-D", "sampels=3"},
      {"--set", "seed"},     {"--set", "sede=3"}, {"--error", "-1"},       {"-o", "a.nothing"}, {"-o", "no/such/a.png"},
      {"--plugin", "no.so"}, {"--size", "0x10"},  {"--crop", "0,0,99,99"},
  };
  for (const auto& options : wrong) {
    std::vector<std::string> arguments{"render", scene};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run(arguments), 2) << options[0] << " " << options[1];
    EXPECT_FALSE(err.empty()) << options[0] << " " << options[1];
  }
}

// ---- bad input --------------------------------------------------------------------------------------------------------

TEST_F(ProgramTest, errors_are_located_and_counted) {
  const std::string bad = folder.write("bad.etd", "Job {\n  renderer: PathTracer { max_dept: 4 }\n  sede: 3\n}\n");
  EXPECT_EQ(run({"check", bad}), 2);
  EXPECT_TRUE(has(err, "bad.etd:2:26:")) << err;
  EXPECT_TRUE(has(err, "did you mean 'max_depth'")) << err;
  EXPECT_TRUE(has(err, "^")) << err;
  EXPECT_TRUE(has(err, "did you mean 'seed'")) << err;
  EXPECT_TRUE(has(err, " errors\n")) << err;
  EXPECT_EQ(out, "");
  EXPECT_EQ(run({"render", folder / "absent.etd"}), 2);
  EXPECT_TRUE(has(err, "absent.etd")) << err;
  EXPECT_EQ(run({"render", scene, "--set", "renderer.max_dept=2"}), 2);
  EXPECT_TRUE(has(err, "did you mean 'max_depth'")) << err;
}

TEST_F(ProgramTest, a_picture_that_cannot_be_written_is_a_failure) {
  Process process(program, {"render", scene, "-o", "taken.png", "-o", "good.npy", "--time", "1s", "--progress", "json"},
                  folder);
  ASSERT_TRUE(process.says("progress")) << process.err();
  std::filesystem::create_directory(folder / "taken.png");  // a folder of that name now stands where the file should be
  EXPECT_EQ(process.wait(), 1);
  EXPECT_TRUE(has(process.err(), "taken.png")) << process.err();
  EXPECT_TRUE(std::filesystem::exists(folder / "good.npy"));
}

// ---- check, save, classes, schema, manual -------------------------------------------------------------------------------

TEST_F(ProgramTest, check_tells_what_a_scene_has) {
  EXPECT_EQ(run({"check", scene}), 0) << err;
  for (const char* word :
       {"objects     2", "triangles   0", "luminaires  1", "24 x 16 pixels", "4 per pixel", "tiny.etd is good"})
    EXPECT_TRUE(has(out, word)) << word << " is not in\n" << out;
  EXPECT_EQ(run({"check", scene, "-D", "samples=9", "--set", "image.width=30"}), 0) << err;
  EXPECT_TRUE(has(out, "9 per pixel") && has(out, "30 x 16 pixels")) << out;
}

TEST_F(ProgramTest, a_saved_file_saves_as_itself_and_renders_the_same) {
  ASSERT_EQ(run({"save", scene, "-o", "saved.etd", "-D", "samples=2"}), 0) << err;
  ASSERT_EQ(run({"save", folder / "saved.etd", "-o", "-"}), 0) << err;
  EXPECT_EQ(out, file_text(folder / "saved.etd"));
  EXPECT_TRUE(has(out, "samples: 2")) << out;
  EXPECT_FALSE(has(out, "time_limit")) << out;
  ASSERT_EQ(run({"save", scene, "--all", "-o", "-"}), 0) << err;
  EXPECT_TRUE(has(out, "time_limit")) << out;
  ASSERT_EQ(run({"render", scene, "-D", "samples=2", "-o", "a.npy"}), 0) << err;
  ASSERT_EQ(run({"render", "saved.etd", "-o", "b.npy"}), 0) << err;
  EXPECT_TRUE(file_text(folder / "a.npy") == file_text(folder / "b.npy"));
  EXPECT_EQ(run({"save", scene, "-o", "no/such/folder.etd"}), 2);
}

TEST_F(ProgramTest, classes) {
  EXPECT_EQ(run({"classes"}), 0) << err;
  EXPECT_TRUE(has(out, "\nRenderer ") && has(out, "\n  PathTracer ")) << out;
  EXPECT_EQ(run({"classes", "PathTracer"}), 0) << err;
  EXPECT_TRUE(has(out, "max_depth") && has(out, "samples")) << out;
  EXPECT_EQ(run({"classes", "Shader"}), 0) << err;
  EXPECT_TRUE(has(out, "Lambertian")) << out;
  EXPECT_EQ(run({"classes", "PathTracer", "--json"}), 0) << err;
  EXPECT_EQ(nlohmann::json::parse(out)["name"], "PathTracer");
  EXPECT_EQ(run({"classes", "--json"}), 0) << err;
  EXPECT_GT(nlohmann::json::parse(out).size(), 20u);
  EXPECT_EQ(run({"classes", "PathTracr"}), 2);
  EXPECT_TRUE(has(err, "did you mean 'PathTracer'")) << err;
}

TEST_F(ProgramTest, schema_is_json) {
  EXPECT_EQ(run({"schema"}), 0) << err;
  const auto schema = nlohmann::json::parse(out);
  EXPECT_EQ(schema["$defs"]["PathTracer"]["properties"]["class"]["const"], "PathTracer");
}

TEST_F(ProgramTest, manual) {
  EXPECT_EQ(run({"manual"}), 0) << err;
  EXPECT_TRUE(has(out, "# Components") && has(out, "\n# PathTracer\n"));
  EXPECT_EQ(run({"manual", "-o", folder / "pages/all"}), 0) << err;
  EXPECT_TRUE(has(file_text(folder / "pages/all/PathTracer.md"), "`max_depth`"));
  EXPECT_TRUE(has(file_text(folder / "pages/all/index.md"), "[PathTracer](PathTracer.md)"));
}

// ---- render -------------------------------------------------------------------------------------------------------------

TEST_F(ProgramTest, render_writes_what_is_asked_for) {
  EXPECT_EQ(run({"render", scene, "-o", "a.png", "-o", "b.npy", "-o", "c.EXR"}), 0) << err;
  EXPECT_TRUE(has(out, "a.png\n") && has(out, "b.npy\n") && has(out, "4 samples per pixel")) << out;
  EXPECT_EQ(file_text(folder / "a.png").substr(1, 3), "PNG");
  const auto values = npy_values(folder / "b.npy");
  EXPECT_EQ(values.size(), 24u * 16u * 3u);
  double sum = 0;
  for (const double v : values) sum += v;
  EXPECT_GT(sum, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "c.EXR"));
  // Without any output option the picture is a PNG named after the scene file.
  EXPECT_EQ(run({"render", scene, "--quiet"}), 0) << err;
  EXPECT_EQ(out + err, "");
  EXPECT_EQ(file_text(folder / "tiny.png").substr(1, 3), "PNG");
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_FALSE(has(entry.path().string(), "part")) << entry.path();
}

TEST_F(ProgramTest, overrides_reach_the_picture) {
  ASSERT_EQ(run({"render", scene, "-o", "a.npy", "--size", "10x8", "--samples", "3", "--set", "renderer.max_depth=2"}), 0)
      << err;
  EXPECT_EQ(npy_values(folder / "a.npy").size(), 10u * 8u * 3u);
  EXPECT_TRUE(has(out, "3 samples per pixel")) << out;
  ASSERT_EQ(run({"render", scene, "-o", "b.npy", "--size", "10x8", "--samples", "3", "-D", "depth=2"}), 0) << err;
  EXPECT_TRUE(file_text(folder / "a.npy") == file_text(folder / "b.npy"));
  ASSERT_EQ(run({"render", scene, "-o", "c.npy", "--crop", "2,3,12,7"}), 0) << err;
  EXPECT_EQ(npy_values(folder / "c.npy").size(), 10u * 4u * 3u);
}

// A crop in the description keeps its part of the picture when --size makes the picture smaller or larger.
TEST_F(ProgramTest, a_crop_keeps_its_part_at_another_size) {
  std::string text = tiny_scene;
  text.replace(text.find("width: 24"), 9, "width: 24, crop: [4, 4, 10, 13]");
  const std::string cropped = folder.write("cropped.etd", text);
  for (const auto& [size, told, pixels] : {std::tuple{"12x8", "becomes [2, 2, 5, 7] of 12 x 8", 3u * 5u},
                                           {"240x160", "becomes [40, 40, 100, 130] of 240 x 160", 60u * 90u}}) {
    ASSERT_EQ(run({"render", cropped, "-o", "a.npy", "--samples", "1", "--size", size}), 0) << err;
    EXPECT_TRUE(has(err, told)) << err;
    EXPECT_EQ(npy_values(folder / "a.npy").size(), pixels * 3u);
  }
}

TEST_F(ProgramTest, the_number_of_threads_changes_no_bit_and_the_seed_does) {
  const auto picture = [&](const std::string& name, const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"render", scene, "-o", name, "--quiet", "--size", "70x50"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run(arguments), 0) << err;
    return file_text(folder / name);
  };
  for (const char* ending : {".npy", ".exr", ".png"}) {
    const std::string one = picture(std::string("one") + ending, {"--threads", "1"});
    EXPECT_FALSE(one.empty());
    // Not EXPECT_EQ: it would print all bytes.
    EXPECT_TRUE(one == picture(std::string("two") + ending, {"--threads", "2"})) << ending;
    EXPECT_TRUE(one == picture(std::string("five") + ending, {"--threads", "5"})) << ending;
    EXPECT_TRUE(one == picture(std::string("again") + ending, {})) << ending;
    EXPECT_TRUE(one != picture(std::string("seed") + ending, {"--seed", "8"})) << ending;
  }
}

TEST_F(ProgramTest, a_replayed_sample_is_the_one_in_the_picture) {
  ASSERT_EQ(run({"render", scene, "-o", "a.npy", "--samples", "1", "--quiet"}), 0) << err;
  const auto values = npy_values(folder / "a.npy");
  ASSERT_EQ(values.size(), 24u * 16u * 3u);
  int lit = 0;
  for (const int x : {9, 11, 13}) {
    for (const int y : {6, 9}) {
      ASSERT_EQ(
          run({"render", scene, "--samples", "1", "--pixel", std::to_string(x) + "," + std::to_string(y), "--sample", "0"}), 0)
          << err;
      EXPECT_TRUE(has(out, "vertex 0:") && has(out, "wavelength [nm]") && has(out, "throughput")) << out;
      const size_t at = out.find("X Y Z");
      ASSERT_NE(at, std::string::npos) << out;
      std::istringstream numbers(out.substr(at + 5));
      for (size_t c = 0; c < 3; ++c) {
        double value = -1;
        numbers >> value;
        const double expected = values[size_t(y * 24 + x) * 3 + c];
        // The values are printed with six digits; negative components are not clipped.
        EXPECT_NEAR(value, expected, 2e-5 * std::abs(expected) + 1e-9) << x << "," << y << " channel " << c << "\n" << out;
        lit += expected > 0;
      }
    }
  }
  EXPECT_GT(lit, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "tiny.png"));
  EXPECT_EQ(run({"render", scene, "--pixel", "99,0", "--sample", "0"}), 2);
}

TEST_F(ProgramTest, progress_in_json) {
  ASSERT_EQ(run({"render", scene, "-o", "a.npy", "--progress", "json", "--samples", "8"}), 0) << err;
  std::istringstream lines(out);
  nlohmann::json last;
  int progress = 0;
  double fraction = 0;
  for (std::string line; std::getline(lines, line);) {
    last = nlohmann::json::parse(line);
    if (last["event"] != "progress") continue;
    ++progress;
    EXPECT_GE(last["fraction"].get<double>(), fraction);
    fraction = last["fraction"];
    EXPECT_EQ(last["samples_wanted"], 8);
  }
  EXPECT_GE(progress, 1);
  EXPECT_EQ(fraction, 1);
  EXPECT_EQ(last["event"], "done");
  EXPECT_EQ(last["samples"], 8);
  EXPECT_EQ(last["ended"], "samples");
  EXPECT_EQ(last["bad_samples"], 0);
  ASSERT_EQ(last["outputs"].size(), 1u);
}

TEST_F(ProgramTest, time_and_error_stop_a_render) {
  ASSERT_EQ(run({"render", scene, "-o", "a.npy", "--progress", "json", "--time", "0.2s"}), 0) << err;
  EXPECT_TRUE(has(out, R"("ended":"time")")) << out;
  ASSERT_EQ(run({"render", scene, "-o", "b.npy", "--progress", "json", "--error", "0.2", "--time", "60"}), 0) << err;
  EXPECT_TRUE(has(out, R"("ended":"error")")) << out;
}

TEST_F(ProgramTest, an_interrupted_render_writes_what_there_is) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::string name = "stopped" + std::to_string(signal) + ".npy";
    Process process(program, {"render", scene, "-o", name, "--samples", "100000000", "--progress", "json"}, folder);
    ASSERT_TRUE(process.says("progress")) << process.err();
    EXPECT_FALSE(std::filesystem::exists(folder / name));
    process.send(signal);
    EXPECT_EQ(process.wait(), 130);
    EXPECT_TRUE(has(process.out(), R"("ended":"interrupted")")) << process.out();
    EXPECT_TRUE(has(process.err(), "Ctrl-C again")) << process.err();
    EXPECT_EQ(npy_values(folder / name).size(), 24u * 16u * 3u);
  }
}

TEST_F(ProgramTest, a_second_interrupt_leaves_out_the_pass_under_way) {
  // One pass takes about a second.
  const auto with = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> all{"render", scene, "--size", "1200x900", "--threads", "1", "-o", name, "--progress", "json"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  Process process(program, with("some.npy", {"--samples", "1000000", "--continue", "state"}), folder);
  ASSERT_TRUE(process.says("\"samples\":1,")) << process.err();
  process.send(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  process.send(SIGINT);
  EXPECT_EQ(process.wait(), 130);
  EXPECT_TRUE(has(process.out(), R"("ended":"aborted")")) << process.out();
  EXPECT_TRUE(has(process.err(), "leaves this pass out") && has(process.err(), "ends at once")) << process.err();
  ASSERT_EQ(run(with("one.npy", {"--samples", "1"})), 0) << err;
  EXPECT_TRUE(file_text(folder / "some.npy") == file_text(folder / "one.npy"));
  ASSERT_EQ(run(with("two.npy", {"--samples", "2", "--continue", "state"})), 0) << err;
  ASSERT_EQ(run(with("two_alone.npy", {"--samples", "2"})), 0) << err;
  EXPECT_TRUE(file_text(folder / "two.npy") == file_text(folder / "two_alone.npy"));
}

TEST_F(ProgramTest, a_second_interrupt_within_the_first_pass_writes_nothing) {
  Process process(program,
                  {"render", scene, "-o", "none.npy", "--size", "4000x3000", "--samples", "1000000", "--progress", "json"},
                  folder);
  ASSERT_TRUE(process.says("progress")) << process.err();
  process.send(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  process.send(SIGINT);
  EXPECT_EQ(process.wait(), 130);
  EXPECT_TRUE(has(process.out(), R"("ended":"aborted")")) << process.out();
  EXPECT_FALSE(std::filesystem::exists(folder / "none.npy"));
}

// ---- image --------------------------------------------------------------------------------------------------------------

TEST_F(ProgramTest, image_commands) {
  ASSERT_EQ(run({"render", scene, "-o", "a.exr", "-o", "a.npy", "--quiet"}), 0) << err;
  ASSERT_EQ(run({"render", scene, "-o", "b.exr", "--seed", "9", "--quiet"}), 0) << err;
  ASSERT_EQ(run({"render", scene, "-o", "small.exr", "--size", "12x16", "--quiet"}), 0) << err;

  EXPECT_EQ(run({"image", "diff", "a.exr", "a.exr", "--tolerance", "0", "--tiles", "8"}), 0) << err;
  EXPECT_EQ(run({"image", "diff", "a.exr", "b.exr"}), 0) << err;
  for (const char* word : {"RMSE", "SMAPE", "maximum"}) EXPECT_TRUE(has(out, word)) << word << "\n" << out;
  EXPECT_EQ(run({"image", "diff", "a.exr", "b.exr", "--tolerance", "1e-6"}), 1);
  EXPECT_EQ(run({"image", "diff", "a.exr", "b.exr", "--tiles", "8", "--tolerance", "1e-6"}), 1);
  EXPECT_EQ(run({"image", "diff", "a.exr", "b.exr", "--tolerance", "1e6"}), 0) << out;
  EXPECT_EQ(run({"image", "diff", "a.exr", "small.exr"}), 2);
  EXPECT_EQ(run({"image", "diff", "a.exr", "absent.exr"}), 2);
  EXPECT_TRUE(has(err, "absent.exr")) << err;

  EXPECT_EQ(run({"image", "info", "a.exr"}), 0) << err;
  EXPECT_TRUE(has(out, "24") && has(out, "16")) << out;

  EXPECT_EQ(run({"image", "tonemap", "a.exr", "toned.png"}), 0) << err;
  EXPECT_EQ(file_text(folder / "toned.png").substr(1, 3), "PNG");
  EXPECT_EQ(run({"image", "tonemap", "a.exr", "toned2.png", "--tone-map", "SchlickToneMap {}"}), 0) << err;
  EXPECT_NE(file_text(folder / "toned.png"), file_text(folder / "toned2.png"));
  EXPECT_EQ(run({"image", "tonemap", "a.exr", "x.png", "--tone-map", "SchlikToneMap {}"}), 2);
  EXPECT_EQ(run({"image", "tonemap", "a.exr", "x.png", "--tone-map", "Sphere {}"}), 2);
  EXPECT_EQ(run({"image"}), 2);
}

}  // namespace
}  // namespace etendue
