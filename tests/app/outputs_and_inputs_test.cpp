// No output replaces a file that is read, none turns out to be impossible only after hours of rendering, and no file is written
// twice.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>

#include "etendue/film/image_tools.h"
#include "support/program_support.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

class OutputsTest : public RunsProgram {
 protected:
  /// A scene that reads a file of each kind: an include, a mesh, a texture, a spectrum, a plugin.
  std::string write_scene(const std::string& name, const std::string& outputs = "") {
    folder.write("lamp.etd", "lamp = DiffuseEmission { radiance: spectrum(\"light.csv\") }\n");
    folder.write("light.csv", "400, 1\n700, 2\n");
    folder.write("mesh.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                 "element face 1\nproperty list uchar int vertex_indices\nend_header\n-1 -1 1\n1 -1 1\n0 1 1\n3 0 1 2\n");
    Image picture(2, 2, {"X", "Y", "Z"});
    std::fill(picture.values.begin(), picture.values.end(), 0.5);
    write_any(picture, folder / "texture.hdr");
    return folder.write(name, "include \"lamp.etd\"\nplugin \"" ETENDUE_BINARY_DIR
                              "/tests/libconform_faults.so\"\n"
                              "Job { renderer: PathTracer { samples: 1, max_depth: 2 }\n"
                              "camera: PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m }\n"
                              "image: ImageBuffer { width: 4, height: 4 }\n" +
                                  outputs +
                                  "scene: BruteForceScene { objects: [\n"
                                  "TriangleMesh { file: \"mesh.ply\", shader: Lambertian { color: 0.5 } },\n"
                                  "Sphere { shader: Lambertian { color: ImageMap { file: \"texture.hdr\" } }, "
                                  "emission: lamp } ] } }\n");
  }

  /// Expects that a command is refused, that it leaves the input file unchanged, and that it writes nothing else.
  void expect_refused(std::vector<std::string> arguments, const std::string& input, const std::string& why) {
    const std::string before = file_text(folder / input);
    arguments.insert(arguments.end(), {"-o", "other.npy"});
    EXPECT_EQ(run(arguments), 2) << input << ": " << out;
    EXPECT_TRUE(says(why)) << input << ": " << err;
    EXPECT_TRUE(file_text(folder / input) == before) << input;
    EXPECT_FALSE(exists("other.npy")) << input;
    EXPECT_EQ(out, "") << input;
  }
};

const std::vector<std::string> all_inputs = {"scene.etd", "lamp.etd", "light.csv", "mesh.ply", "texture.hdr"};

TEST_F(OutputsTest, an_input_is_not_overwritten_by_whatever_name) {
  const std::string scene = write_scene("scene.etd");
  ASSERT_EQ(run({"render", scene, "-o", "good.npy"}), 0) << err;
  fs::create_directory(folder / "in");
  for (const std::string& input : all_inputs) {
    fs::create_symlink(folder / input, folder / "link.npy");
    fs::create_hard_link(folder / input, folder / "hard.npy");
    fs::create_symlink("../hard.npy", folder / "in/twice.npy");
    for (const char* name : {"link.npy", "hard.npy", "in/twice.npy", "./in/../link.npy"})
      expect_refused({"render", scene, "-o", name}, input, "would be overwritten");
    expect_refused({"render", scene, "-o", folder / "hard.npy"}, input, "would be overwritten");
    // A checkpoint can have any name, so it can have the name of an input too.
    expect_refused({"render", scene, "--checkpoint", input}, input, "would be overwritten");
    expect_refused({"render", scene, "--checkpoint", "in/../" + input}, input, "would be overwritten");
    for (const char* name : {"link.npy", "hard.npy", "in/twice.npy"}) fs::remove(folder / name);
  }
  expect_refused({"render", scene, "-o", "texture.hdr"}, "texture.hdr", "'texture.hdr' would be overwritten");
  // The plugin is read as well.
  const std::string plugin = ETENDUE_BINARY_DIR "/tests/libconform_faults.so";
  fs::create_symlink(plugin, folder / "plugin.npy");
  expect_refused({"render", scene, "-o", "plugin.npy"}, "plugin.npy", "would be overwritten");
  // Files that are not read may be replaced.
  EXPECT_EQ(run({"render", scene, "-o", "good.npy"}), 0) << err;
}

TEST_F(OutputsTest, the_outputs_of_the_description_and_the_usual_name_are_looked_at_too) {
  const std::string scene = write_scene("scene.etd", "outputs: [ HdrOutput { file: \"texture.hdr\" } ]\n");
  EXPECT_EQ(run({"render", scene}), 2);
  EXPECT_TRUE(says("scene.etd:6:") && says("would be overwritten")) << err;
  // Without an output name the picture is named after the description.
  const std::string png = write_scene("scene.png");
  EXPECT_EQ(run({"render", png}), 2);
  EXPECT_TRUE(says("would be overwritten")) << err;
}

TEST_F(OutputsTest, other_commands_do_not_overwrite_inputs_either) {
  const std::string scene = write_scene("scene.etd");
  for (const std::string& input : all_inputs) {
    const std::string before = file_text(folder / input);
    for (const std::vector<std::string>& command :
         std::vector<std::vector<std::string>>{{"save", scene, "-o", input},
                                               {"render", scene, "--pixel", "1,1", "--replay", input},
                                               {"verify", scene, "--samples", "8", "--report", input}}) {
      EXPECT_EQ(run(command), 2) << command[0] << " " << input;
      EXPECT_TRUE(says("would be overwritten")) << command[0] << " " << input << ": " << err;
      EXPECT_TRUE(file_text(folder / input) == before);
    }
  }
  ASSERT_EQ(run({"render", scene, "-o", "a.npy"}), 0) << err;
  const std::string before = file_text(folder / "a.npy");
  EXPECT_EQ(run({"image", "tonemap", "a.npy", "a.npy"}), 2);
  EXPECT_TRUE(says("would be overwritten")) << err;
  EXPECT_EQ(file_text(folder / "a.npy"), before);
}

TEST_F(OutputsTest, checkpoints_that_are_read_are_inputs) {
  const std::string scene = write_scene("scene.etd");
  ASSERT_EQ(run({"render", scene, "-o", "a.npy", "--checkpoint", "a.part"}), 0) << err;
  fs::create_hard_link(folder / "a.part", folder / "part.npy");
  const std::string before = file_text(folder / "a.part");
  EXPECT_EQ(run({"render", scene, "--resume", "a.part", "-o", "part.npy"}), 2);
  EXPECT_TRUE(says("would be overwritten")) << err;
  EXPECT_EQ(run({"image", "merge", "a.part", "-o", "part.npy"}), 2);
  EXPECT_TRUE(says("would be overwritten")) << err;
  EXPECT_EQ(run({"image", "merge", "a.part", "-o", "b.npy", "--checkpoint", "part.npy"}), 2);
  EXPECT_TRUE(says("would be overwritten")) << err;
  EXPECT_TRUE(file_text(folder / "a.part") == before);
  // The new state is written to the checkpoint that was read, as --resume and --continue document.
  EXPECT_EQ(run({"render", scene, "--resume", "a.part", "--samples", "2", "-o", "a.npy"}), 0) << err;
  EXPECT_EQ(run({"render", scene, "--continue", "a.part", "--samples", "4", "-o", "a.npy"}), 0) << err;
  EXPECT_EQ(run({"render", scene, "--resume", "a.part", "--checkpoint", "./a.part", "--samples", "8", "-o", "a.npy"}), 0)
      << err;
  // A checkpoint with another name is an output like any other.
  EXPECT_EQ(run({"render", scene, "--resume", "a.part", "--checkpoint", "mesh.ply", "--samples", "8", "-o", "a.npy"}), 2);
  EXPECT_TRUE(says("would be overwritten")) << err;
}

TEST_F(OutputsTest, no_file_is_written_twice) {
  const std::string scene = write_scene("scene.etd");
  EXPECT_EQ(run({"render", scene, "-o", "a.npy", "-o", "./a.npy"}), 2);
  EXPECT_TRUE(says("'./a.npy' is the same file as 'a.npy'")) << err;
  EXPECT_EQ(run({"render", scene, "-o", "a.npy", "-o", "a.npy"}), 2);
  EXPECT_TRUE(says("'a.npy' would be written twice")) << err;
  EXPECT_EQ(run({"render", scene, "-o", "a.npy", "--checkpoint", "a.npy"}), 2);
  EXPECT_FALSE(exists("a.npy"));
  ASSERT_EQ(run({"render", scene, "-o", "a.npy", "-o", "b.npy"}), 0) << err;
  fs::remove(folder / "b.npy");
  fs::create_symlink("a.npy", folder / "b.npy");
  EXPECT_EQ(run({"render", scene, "-o", "a.npy", "-o", "b.npy"}), 2);
}

TEST_F(OutputsTest, what_cannot_be_written_is_refused_before_anything_is_rendered) {
  const std::string scene = write_scene("scene.etd");
  fs::create_directory(folder / "folder.npy");
  fs::create_symlink("/dev/full", folder / "full.npy");
  const std::string long_name(300, 'x');
  const auto refused = [&](const std::string& file) {
    // So many samples that the test would not end if rendering began.
    EXPECT_EQ(run({"render", scene, "--samples", "1000000000", "-o", file}), 2) << file;
    EXPECT_TRUE(says("cannot write")) << file << ": " << err;
  };
  refused("no/such/a.npy");
  refused("folder.npy");
  refused("full.npy");
  EXPECT_TRUE(says("No space left")) << err;
  refused(long_name + ".npy");
  refused("scene.etd/a.npy");
  for (const char* option : {"--checkpoint", "--continue"}) {
    EXPECT_EQ(run({"render", scene, "--samples", "1000000000", "-o", "a.npy", option, "no/such/a.part"}), 2) << option;
    EXPECT_TRUE(says("cannot write 'no/such/a.part'")) << err;
  }
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"save", scene, "-o", "no/such/a.etd"},
                                             {"save", scene, "-o", "folder.npy"},
                                             {"render", scene, "--pixel", "1,1", "--replay", "no/such/a.json"},
                                             {"verify", scene, "--samples", "1000000000", "--report", "no/such/a.html"},
                                             {"conform", "--report", "no/such/a.html"},
                                             {"image", "tonemap", "texture.hdr", "no/such/a.png"}}) {
    EXPECT_EQ(run(command), 2) << command[0];
    EXPECT_TRUE(says("cannot write")) << command[0] << ": " << err;
  }
  if (geteuid() == 0) return;  // root may write anywhere
  fs::create_directory(folder / "closed");
  fs::permissions(folder / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  refused("closed/a.npy");
}

TEST_F(OutputsTest, looking_leaves_nothing_behind) {
  const std::string scene = write_scene("scene.etd");
  ASSERT_EQ(run({"check", scene}), 0) << err;
  folder.write("old.npy", "as it was");
  EXPECT_EQ(run({"render", scene, "-o", "new.npy", "-o", "old.npy", "-o", "no/such.npy"}), 2);
  EXPECT_EQ(file_text(folder / "old.npy"), "as it was");
  EXPECT_FALSE(exists("new.npy"));
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
    EXPECT_EQ(entry.path().filename().string().find(".part-"), std::string::npos) << entry.path();
}

TEST_F(OutputsTest, devices_are_written_to_not_replaced) {
  const std::string scene = write_scene("scene.etd");
  ASSERT_EQ(run({"save", scene, "-o", "/dev/stdout"}), 0) << err;
  EXPECT_NE(out.find("Job {"), std::string::npos) << out;
  EXPECT_TRUE(fs::is_symlink("/dev/stdout"));
}

// After a symbolic link to a folder, ".." is the parent folder of the link's target, not the folder that contains the link.
TEST_F(OutputsTest, an_input_behind_a_linked_folder_is_not_overwritten) {
  const std::string scene = write_scene("scene.etd");
  fs::create_directories(folder / "real/sub");
  fs::create_directory_symlink("real/sub", folder / "linked");
  fs::copy_file(folder / "texture.hdr", folder / "real/texture.hdr");
  std::string text = file_text(folder / "scene.etd");
  const std::string name = "\"texture.hdr\"";
  folder.write("behind.etd", text.replace(text.find(name), name.size(), "\"linked/../texture.hdr\""));
  expect_refused({"render", folder / "behind.etd", "-o", folder / "real/texture.hdr"}, "real/texture.hdr", "texture.hdr");
}

// A symbolic link whose target does not exist yet stays a link; a pipe without a reader does not block the program.
TEST_F(OutputsTest, links_stay_and_pipes_do_not_hold) {
  const std::string scene = write_scene("scene.etd", "");
  fs::create_symlink("target.npy", folder / "link.npy");
  ASSERT_EQ(run({"render", scene, "-o", "link.npy"}), 0) << err;
  EXPECT_TRUE(fs::is_symlink(folder / "link.npy"));
  EXPECT_TRUE(fs::is_regular_file(folder / "target.npy"));
  ASSERT_EQ(::mkfifo((folder / "pipe.npy").c_str(), 0600), 0);
  EXPECT_NE(run({"render", scene, "-o", "pipe.npy", "-o", "file.npy"}), 0);
  EXPECT_TRUE(says("'pipe.npy': it is a pipe that nobody reads")) << err;
  EXPECT_TRUE(exists("file.npy"));
}

}  // namespace
}  // namespace etendue
