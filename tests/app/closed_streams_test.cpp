// The program with closed or full standard streams, with signals, with meaningless option values, and with unusual folders and
// names.

#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>

#include <algorithm>
#include <functional>
#include <regex>

#include "support/program_support.h"

namespace etendue {
namespace {

const char* const tiny_scene = R"(Job {
    renderer: PathTracer { max_depth: 3, samples: 4 }
    camera:   PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 45 deg }
    image:    ImageBuffer { width: 24, height: 16, filter: BoxFilter {} }
    scene:    BruteForceScene { objects: [
        Sphere { radius: 1 m, shader: Lambertian { color: 0.5 } },
        Sphere { radius: 0.5 m, transform: translate(0, 2 m, -1 m), emission: DiffuseEmission { radiance: 5 } } ] }
}
)";

class StreamsTest : public RunsProgram {
 protected:
  void SetUp() override { scene = folder.write("tiny.etd", tiny_scene); }

  /// A shell's command line, in which "$E" is the program.
  int shell(const std::string& command) {
    return finish(Process("/bin/sh", {"-c", "E='" + program + "'; " + command}, folder));
  }
  std::string scene;
};

// ---- standard output and error ------------------------------------------------------------------------------------------

TEST_F(StreamsTest, lost_output_is_failure_for_every_command) {
  ASSERT_EQ(run({"render", scene, "-o", "a.npy", "--checkpoint", "a.part"}), 0) << err;
  for (const char* command :
       {"--help", "--version", "render --help", "classes", "classes PathTracer", "classes --json", "schema", "manual",
        "check tiny.etd", "save tiny.etd -o -", "image info a.npy", "image diff a.npy a.npy", "image merge a.part -o m.npy",
        "render tiny.etd -o b.npy", "render tiny.etd -o c.npy --progress json", "render tiny.etd --pixel 3,3 --paths 1",
        "render tiny.etd -o f.npy --fireflies 2", "conform BoxFilter --quick --drawn 0",
        "verify tiny.etd --samples 8 --passes 8 --renderers PathTracer,DistributionRenderer"}) {
    EXPECT_EQ(shell("\"$E\" " + std::string(command) + " > /dev/full"), 1) << command;
    EXPECT_TRUE(says("cannot write to standard output")) << command << ": " << err;
    EXPECT_FALSE(says("unexpected")) << command << ": " << err;
    EXPECT_EQ(shell("\"$E\" " + std::string(command) + " >&-"), 1) << command;
    EXPECT_TRUE(says("cannot write to standard output")) << command << ": " << err;
  }
  // Output to files is written nevertheless.
  for (const char* picture : {"b.npy", "c.npy", "f.npy", "m.npy"}) EXPECT_TRUE(exists(picture)) << picture;
  // A command that prints nothing cannot lose output, so it succeeds.
  EXPECT_EQ(shell("\"$E\" render tiny.etd -o d.npy --quiet > /dev/full"), 0) << err;
}

TEST_F(StreamsTest, lost_errors_change_nothing) {
  for (const char* streams : {"2>&-", "2> /dev/full", ">&- 2>&- <&-", "> /dev/full 2> /dev/full"}) {
    EXPECT_NE(shell("\"$E\" render nothing.etd " + std::string(streams)), 0);
    EXPECT_EQ(shell("\"$E\" render tiny.etd -o e.npy --progress bar --quiet " + std::string(streams)), 0) << streams;
    EXPECT_TRUE(exists("e.npy")) << streams;
    std::filesystem::remove(folder / "e.npy");
    EXPECT_NE(shell("\"$E\" classes Nothing " + std::string(streams)), 0);
  }
  for (const char* streams : {"2>&-", "2> /dev/full"}) {  // with much progress output
    EXPECT_EQ(shell("\"$E\" render tiny.etd -o e.npy --progress bar " + std::string(streams)), 0) << streams;
    EXPECT_TRUE(exists("e.npy")) << streams;
    std::filesystem::remove(folder / "e.npy");
  }
  EXPECT_EQ(shell("\"$E\" classes 2>&-"), 0);
  EXPECT_EQ(shell("\"$E\" classes <&-"), 0);
}

TEST_F(StreamsTest, nothing_is_written_into_a_file_that_took_the_place_of_a_closed_stream) {
  ASSERT_EQ(run({"render", scene, "-o", "good.npy"}), 0) << err;
  // The closed stream's descriptor is free, so the checkpoint and the picture could be opened under its number while progress
  // and messages are printed to it.
  const std::string render = "\"$E\" render tiny.etd --progress json --checkpoint s.part --every 0 -o ";
  EXPECT_EQ(shell(render + "a.npy >&-"), 1) << err;
  shell(render + "b.npy >&- 2>&-");
  shell(render + "c.npy >&- 2>&- <&-");
  for (const char* name : {"a.npy", "b.npy", "c.npy"})
    EXPECT_EQ(file_text(folder / name), file_text(folder / "good.npy")) << name;
  EXPECT_EQ(run({"image", "merge", "s.part", "-o", "d.npy"}), 0) << err;
  EXPECT_EQ(file_text(folder / "d.npy"), file_text(folder / "good.npy"));
}

TEST_F(StreamsTest, a_reader_that_goes_away_does_not_end_a_render) {
  // The reader is gone after a quarter of a second.
  EXPECT_EQ(shell("(\"$E\" render tiny.etd --time 1s -o a.npy --progress json; echo $? > status) | head -1 > first"), 0);
  EXPECT_EQ(file_text(folder / "status"), "0\n");
  EXPECT_TRUE(exists("a.npy"));
  EXPECT_NE(file_text(folder / "first").find("progress"), std::string::npos);
  EXPECT_EQ(err, "");
  EXPECT_EQ(shell("\"$E\" manual | head -1 > first"), 0);
  EXPECT_EQ(err, "");
}

// ---- signals ----------------------------------------------------------------------------------------------------------------

TEST_F(StreamsTest, a_terminal_that_hangs_up_ends_a_render_with_its_picture) {
  Process process(program, {"render", scene, "--samples", "1000000000", "-o", "a.npy", "--progress", "json"}, folder);
  ASSERT_TRUE(process.says("progress")) << process.err();
  process.send(SIGHUP);
  EXPECT_EQ(process.wait(), 130);
  EXPECT_NE(process.out().find("interrupted"), std::string::npos);
  EXPECT_TRUE(exists("a.npy"));
}

TEST_F(StreamsTest, under_nohup_it_goes_on) {
  Process process("/bin/sh", {"-c", "trap '' HUP; exec '" + program + "' render tiny.etd --time 1s -o a.npy --progress json"},
                  folder);
  ASSERT_TRUE(process.says("progress")) << process.err();
  process.send(SIGHUP);
  EXPECT_EQ(process.wait(), 0) << process.err();
  EXPECT_TRUE(exists("a.npy"));
}

TEST_F(StreamsTest, a_reader_that_stalls_does_not_keep_a_render_from_ending_with_its_picture) {
  const std::string fifo = folder / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  const int reader = open(fifo.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);  // reads nothing; can write as well
  ASSERT_GE(reader, 0);
  Process process("/bin/sh",
                  {"-c", "exec '" + program + "' render tiny.etd --samples 1000000000 -o a.npy --progress json > fifo 2>&1"},
                  folder);
  const auto comes = [](const std::function<bool()>& condition) {
    for (int i = 0; i < 6000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return condition();
  };
  int printed = 0;
  EXPECT_TRUE(comes([&] { return ioctl(reader, FIONREAD, &printed) == 0 && printed > 0; }));
  const std::vector<char> page(4096, ' ');
  for (const size_t size : {page.size(), size_t(1)})  // fills the buffer to the last byte
    while (write(reader, page.data(), size) > 0) continue;
  process.send(SIGTERM);
  EXPECT_TRUE(comes([&] { return exists("a.npy"); }));
  if (exists("a.npy")) EXPECT_EQ(process.wait(), 130);
  close(reader);
}

// ---- values that mean nothing
// -------------------------------------------------------------------------------------------------

TEST_F(StreamsTest, no_option_takes_an_empty_value) {
  int options = 0;
  for (const char* command : {"render", "check", "save", "classes", "schema", "manual", "image diff", "image info",
                              "image tonemap", "image merge", "verify", "conform"}) {
    ASSERT_EQ(shell("\"$E\" " + std::string(command) + " --help"), 0);
    const std::string help = out;
    // "  --checkpoint FILE   …", "  -o,--output FILE …": an option's long name and the name of its value.
    const std::regex option("(?:^|\n) +(?:-[A-Za-z],)?(--[a-z-]+) (?!Excludes|Needs)[A-Z]");
    for (std::sregex_iterator found(help.begin(), help.end(), option), end; found != end; ++found) {
      const std::string name = (*found)[1];
      ++options;
      EXPECT_EQ(shell("\"$E\" " + std::string(command) + " " + name + " \"\""), 2) << command << " " << name;
      EXPECT_TRUE(says(name) && says("empty")) << command << " " << name << ": " << err;
    }
    EXPECT_EQ(shell("\"$E\" " + std::string(command) + " \"\""), 2) << command << " with an empty argument";
  }
  EXPECT_GT(options, 40);
  EXPECT_FALSE(std::filesystem::exists(folder / "tiny.npy"));
  EXPECT_EQ(run({"render", scene, "-D", "samples="}), 2);
  EXPECT_EQ(run({"render", scene, "--set", "seed="}), 2);
}

TEST_F(StreamsTest, limits_that_limit_nothing_are_refused) {
  const std::vector<std::vector<std::string>> wrong = {{"--error", "0"},     {"--error", "0.0"}, {"--error", "-1"},
                                                       {"--time", "0"},      {"--time", "0s"},   {"--error", "x"},
                                                       {"--fireflies", "0"}, {"--samples", "0"}, {"--size", "0x4"}};
  for (const std::vector<std::string>& option : wrong) {
    EXPECT_EQ(run({"render", scene, "-o", "a.npy", option[0], option[1]}), 2) << option[0] << " " << option[1];
    EXPECT_FALSE(exists("a.npy"));
  }
  run({"render", scene, "-o", "a.npy", "--error", "0"});
  EXPECT_TRUE(says("--error") && says("no limit")) << err;
  EXPECT_EQ(run({"verify", scene, "--time", "0"}), 2);
  EXPECT_EQ(run({"manual", "--samples", "0"}), 2);
}

TEST_F(StreamsTest, a_test_of_nothing_is_no_success) {
  EXPECT_EQ(run({"conform", "Handle", "--plugin", ETENDUE_CONFORM_FAULTS_LIBRARY, "--quick"}), 1);
  EXPECT_TRUE(says("nothing was tested")) << err;
  EXPECT_EQ(run({"conform", "BoxFilter", "--quick", "--drawn", "0"}), 0) << err;
}

// ---- folders and names
// ----------------------------------------------------------------------------------------------------------

TEST_F(StreamsTest, works_in_a_folder_that_is_gone) {
  const std::string gone = "mkdir gone && cd gone && rmdir ../gone && ";
  for (const char* command : {"classes", "schema", "check \"$F/tiny.etd\"", "save \"$F/tiny.etd\" -o -",
                              "render \"$F/tiny.etd\" -o \"$F/a.npy\" --checkpoint \"$F/a.part\"", "image info \"$F/a.npy\"",
                              "save \"$F/tiny.etd\" -o \"$F/saved.etd\""})
    EXPECT_EQ(shell("F=\"$PWD\"; " + gone + "\"$E\" " + command), 0) << command << ": " << err;
  EXPECT_TRUE(exists("a.npy"));
  for (const char* command : {"check tiny.etd", "render \"$F/tiny.etd\" -o b.npy", "render \"$F/tiny.etd\"",
                              "save \"$F/tiny.etd\" -o s.etd", "render \"$F/tiny.etd\" -o \"$F/b.npy\" --checkpoint b.part",
                              "image info a.npy", "verify \"$F/tiny.etd\" --report r.html"}) {
    EXPECT_EQ(shell("F=\"$PWD\"; " + gone + "\"$E\" " + command), 2) << command;
    EXPECT_TRUE(says("error")) << command << ": " << err;
    EXPECT_FALSE(says("unexpected")) << command << ": " << err;
  }
}

TEST_F(StreamsTest, names_need_not_be_utf8) {
  const std::string odd = "caf\xe9";
  std::filesystem::create_directory(folder / odd);
  const std::string file = folder.write(odd + "/" + odd + ".etd", tiny_scene);
  const std::string picture = odd + ".npy";
  EXPECT_EQ(run({"check", file}), 0) << err;
  EXPECT_EQ(run({"save", file, "-o", odd + "/saved.etd"}), 0) << err;
  EXPECT_EQ(run({"render", file, "-o", picture, "--progress", "json"}), 0) << err;
  EXPECT_NE(out.find("\"done\""), std::string::npos) << out;
  EXPECT_TRUE(exists(picture));
  for (const char* ending : {".exr", ".png"}) EXPECT_EQ(run({"render", file, "-o", odd + ending}), 0) << err;
  EXPECT_EQ(run({"image", "info", picture}), 0) << err;
  EXPECT_EQ(run({"render", file, "--pixel", "3,3", "--replay", odd + ".json"}), 0) << err;
  EXPECT_EQ(
      run({"verify", file, "--json", "--samples", "8", "--passes", "8", "--renderers", "PathTracer,DistributionRenderer"}), 0)
      << err;
  EXPECT_EQ(run({"render", file, "-o", picture, "--checkpoint", odd + ".part"}), 0) << err;
  EXPECT_EQ(run({"render", file, "-o", picture, "--resume", odd + ".part"}), 0) << err;
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{"check", odd},
                                             {"render", scene, "-o", odd},
                                             {"classes", odd},
                                             {"render", scene, "-D", odd + "=1"},
                                             {"render", scene, "--set", odd + "=1"},
                                             {"render", scene, "--set", "seed=\"" + odd + "\""},
                                             {odd},
                                             {"render", scene, "--" + odd},
                                             {"image", "info", odd + "2"},
                                             {"conform", odd}}) {
    EXPECT_EQ(run(wrong), 2) << wrong[0];
    EXPECT_FALSE(err.empty()) << wrong[0];
    EXPECT_FALSE(says("unexpected")) << err;
  }
}

}  // namespace
}  // namespace etendue
