// `mpirun etendue render`, where there is an mpirun.

#include <gtest/gtest.h>

#include "support/program_support.h"

namespace etendue {
namespace {

class MpiProgram : public RunsProgram {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(ETENDUE_BINARY_DIR "/libetendue_mpi.so")) GTEST_SKIP() << "built without MPI";
    for (const char* path : {"/usr/bin/mpirun", "/usr/local/bin/mpirun"})
      if (std::filesystem::exists(path)) mpirun_ = path;
    if (mpirun_.empty()) GTEST_SKIP() << "there is no mpirun";
    folder.write("a.etd",
                 "Job {\n renderer: GuidedPathTracer { samples: 24 }\n"
                 " camera: PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 40 deg }\n"
                 " image: ImageBuffer { width: 60, height: 50 }\n scene: BvhScene { objects: [\n"
                 "  Sphere { radius: 1 m, shader: Lambertian {} }\n"
                 "  Sphere { centre: [frame, 2, -1] m, radius: 0.5 m, emission: DiffuseEmission { radiance: 5 } }\n ] }\n}\n");
  }
  std::vector<std::string> with(int ranks, const std::vector<std::string>& arguments) const {
    std::vector<std::string> all{
        "--oversubscribe", "--allow-run-as-root", "--bind-to", "none", "-n", std::to_string(ranks), program,
        "render",          folder / "a.etd",      "--threads", "1"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
  }
  int run_ranks(int ranks, const std::vector<std::string>& arguments) {
    return finish(Process(mpirun_, with(ranks, arguments), folder));
  }
  std::string mpirun_;
};

TEST_F(MpiProgram, renders_the_bytes_of_one_process) {
  ASSERT_EQ(run({"render", folder / "a.etd", "--frames", "0:2", "-o", folder / "alone#.npy"}), 0) << err;
  ASSERT_EQ(run_ranks(3, {"--frames", "0:2", "-o", folder / "team#.npy"}), 0) << err;
  EXPECT_EQ(err, "");
  for (const char* frame : {"0.npy", "1.npy"}) {
    const std::string alone = file_text(folder / (std::string("alone") + frame));
    EXPECT_GT(alone.size(), 60 * 50 * 24u);
    EXPECT_TRUE(alone == file_text(folder / (std::string("team") + frame)));
  }
}

TEST_F(MpiProgram, a_killed_process_ends_the_render_and_others_continue_it) {
  const std::vector<std::string> endless{"--samples",  "1000000",        "--every", "0s",
                                         "--continue", folder / "state", "-o",      folder / "no.npy"};
  {
    // A shell tells the number of the process that is to be killed.
    const std::string script =
        folder.write("rank.sh", "[ $OMPI_COMM_WORLD_RANK = 1 ] && echo $$ > " + (folder / "number") + "\nexec \"$@\"\n");
    std::vector<std::string> arguments = with(3, endless);
    const auto at = std::ranges::find(arguments, program);
    arguments.insert(at, {"/bin/sh", script});
    Process process(mpirun_, arguments, folder);
    for (int i = 0; i < 3000 && !exists("state"); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_TRUE(exists("state")) << process.err();
    ::kill(std::stoi(file_text(folder / "number")), SIGKILL);
    EXPECT_NE(finish(std::move(process)), 0);
    EXPECT_TRUE(says("rank 1") && says("signal 9")) << err;
  }
  ASSERT_EQ(run({"image", "merge", folder / "state", "-o", folder / "some.npy"}), 0) << err;
  const std::string more = std::to_string(std::stoi(out.substr(out.find('\n') + 1)) + 8);
  ASSERT_EQ(run_ranks(2, {"--samples", more, "--continue", folder / "state", "-o", folder / "team.npy"}), 0) << err;
  ASSERT_EQ(run({"render", folder / "a.etd", "--samples", more, "-o", folder / "alone.npy"}), 0) << err;
  EXPECT_TRUE(file_text(folder / "alone.npy") == file_text(folder / "team.npy"));
}

// Followers see an empty folder in place of the scene's, as they would on another machine.
TEST_F(MpiProgram, sends_the_scene_to_processes_that_do_not_see_it) {
  if (std::system("unshare -rm true 2>/dev/null") != 0) GTEST_SKIP() << "mount namespaces are not allowed here";
  for (const char* made : {"far", "far/scene", "far/scene/parts", "far/maps", "tmp"})
    std::filesystem::create_directory(folder / made);
  folder.write("far/scene/parts/red.csv", "400 0.1\n700 0.8\n");
  folder.write("far/scene/parts/red.etd", "red = Lambertian { color: spectrum(\"red.csv\") }\n");
  folder.write("far/maps/grey.csv", "400 0.5\n700 0.5\n");
  folder.write("far/maps/patch.obj", "mtllib patch.mtl\nv -1 -1 1\nv 1 -1 1\nv 0 1 1\nusemtl blue\nf 1 2 3\n");
  folder.write("far/maps/patch.mtl", "newmtl blue\nKd 0.1 0.2 0.9\n");
  folder.write("far/scene/a.etd",
               "include \"parts/red.etd\"\nJob {\n renderer: PhotonMapper { samples: 2 }\n"
               " camera: PerspectiveCamera { from: [0, 0, -5] m, to: [0, 0, 0] m, fov: 40 deg }\n"
               " image: ImageBuffer { width: 40, height: 30 }\n scene: BvhScene { objects: [\n"
               "  Sphere { centre: [frame, 0, 0] m, radius: 1 m, shader: red }\n"
               "  Sphere { centre: [0, -101, 0] m, radius: 100 m, shader: Lambertian { color: spectrum(\"" +
                   (folder / "far/maps/grey.csv") +
                   "\") } }\n  Import { file: \"../maps/patch.obj\" }\n"
                   "  Sphere { centre: [0, 3, -1] m, radius: 0.5 m, emission: DiffuseEmission { radiance: 5 } }\n ] }\n}\n");
  const std::string hide =
      folder.write("hide.sh", "export TMPDIR=" + (folder / "tmp") +
                                  "\n[ $OMPI_COMM_WORLD_RANK = 0 ] && exec \"$@\"\nexec unshare -rm sh -c 'cd /; mount -t "
                                  "tmpfs none \"$0\" && exec \"$@\"' " +
                                  (folder / "far") + " \"$@\"\n");
  const auto sent = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "--oversubscribe", "--allow-run-as-root", "--bind-to", "none", "-n", "3", "/bin/sh", hide, program,
        "render",          "--threads",           "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return finish(Process(mpirun_, arguments, folder, folder / "far/scene"));
  };
  ASSERT_EQ(run({"render", folder / "far/scene/a.etd", "--frames", "0:2", "-o", folder / "alone#.npy"}), 0) << err;
  for (const std::string& named : {std::string("a.etd"), folder / "far/scene/a.etd"}) {
    EXPECT_NE(sent({named, "-o", folder / "no.npy"}), 0);
    ASSERT_EQ(sent({named, "--frames", "0:2", "-o", folder / "team#.npy", "--send-scene"}), 0) << err;
    EXPECT_TRUE(has(out, "sent ") && has(out, " of the scene's 6 files to 1 process")) << out;  // the other takes it from there
    for (const char* frame : {"0.npy", "1.npy"})
      EXPECT_TRUE(file_text(folder / (std::string("alone") + frame)) == file_text(folder / (std::string("team") + frame)));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder / "tmp"));
}

TEST_F(MpiProgram, when_mpirun_is_killed_a_file_says_so_and_nobody_goes_on) {
  const std::string script = folder.write("rank.sh", "echo $$ > " + (folder / "rank") + "$OMPI_COMM_WORLD_RANK\nexec \"$@\"\n");
  std::vector<std::string> arguments =
      with(2, {"--samples", "1000000", "--every", "0s", "--continue", folder / "state", "-o", folder / "no.npy"});
  arguments.insert(std::ranges::find(arguments, program), {"/bin/sh", script});
  Process process(mpirun_, arguments, folder);
  for (int i = 0; i < 3000 && !exists("state"); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(exists("state")) << process.err();
  process.send(SIGKILL);
  EXPECT_NE(finish(std::move(process)), 0);
  // There for a moment before its text is.
  const auto told = [&] { return exists("state.killed.txt") && has(file_text(folder / "state.killed.txt"), "process 0 on "); };
  for (int i = 0; i < 3000 && !told(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(told());
  // What has ended and waits to be collected has no command line.
  for (const char* rank : {"rank0", "rank1"})
    EXPECT_EQ(file_text("/proc/" + std::to_string(std::stoi(file_text(folder / rank))) + "/cmdline"), "") << rank;
  EXPECT_EQ(run({"image", "merge", folder / "state", "-o", folder / "some.npy"}), 0) << err;
}

TEST_F(MpiProgram, refuses_what_would_be_a_mixture) {
  const auto ranks = [&](const std::string& color) {
    return std::vector<std::string>{"-n",
                                    "1",
                                    program,
                                    "render",
                                    folder / "a.etd",
                                    "--set",
                                    "scene.objects[0].shader.color=" + color,
                                    "-o",
                                    folder / "a.npy"};
  };
  std::vector<std::string> arguments{"--oversubscribe", "--allow-run-as-root"};
  for (const std::string& one : ranks("0.5")) arguments.push_back(one);
  arguments.push_back(":");
  for (const std::string& one : ranks("0.6")) arguments.push_back(one);
  EXPECT_NE(finish(Process(mpirun_, arguments, folder)), 0);
  EXPECT_TRUE(says("the processes do not render the same: process 1 on ") && says("0.6")) << err;
  EXPECT_FALSE(exists("a.npy"));
}

}  // namespace
}  // namespace etendue
