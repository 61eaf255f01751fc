// Several files and the frames of films in one run of the program.

#include <gtest/gtest.h>

#include "support/program_support.h"

namespace etendue {
namespace {

/// An emitting sphere whose position depends on the frame and the time.
const char* const film = R"(Job {
    renderer: PathTracer { samples: 2 }
    camera: PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 45 deg }
    image: ImageBuffer { width: 12, height: 8 }
    scene: BruteForceScene { objects: [
        Sphere { centre: [frame / 10, time / (1 s), 0], radius: 0.5 m, emission: DiffuseEmission { radiance: 5 } } ] }
}
)";

class SeriesProgramTest : public RunsProgram {
 protected:
  void SetUp() override { folder.write("film.etd", film); }
};

TEST_F(SeriesProgramTest, frames_are_rendered_each_for_itself) {
  ASSERT_EQ(run({"render", "film.etd", "--frames", "2:9:3", "--fps", "10", "-o", "f.##.npy"}), 0) << err;
  EXPECT_TRUE(exists("f.02.npy") && exists("f.05.npy") && exists("f.08.npy"));
  EXPECT_FALSE(exists("f.03.npy") || exists("f.11.npy") || exists("f.##.npy"));
  EXPECT_NE(file_text(folder / "f.02.npy"), file_text(folder / "f.05.npy"));
  // The same frame rendered alone, and from a saved description of that frame.
  ASSERT_EQ(run({"render", "film.etd", "--frame", "5", "--fps", "10", "-o", "one.npy"}), 0) << err;
  EXPECT_EQ(file_text(folder / "f.05.npy"), file_text(folder / "one.npy"));
  ASSERT_EQ(run({"save", "film.etd", "--frame", "5", "--fps", "10", "-o", "still.etd"}), 0) << err;
  ASSERT_EQ(run({"render", "still.etd", "-o", "still.npy"}), 0) << err;
  EXPECT_EQ(file_text(folder / "f.05.npy"), file_text(folder / "still.npy"));
  // Without an output name, and with names given in the file.
  ASSERT_EQ(run({"render", "film.etd", "--frames", "0:2", "--quiet"}), 0) << err;
  EXPECT_TRUE(exists("film.0000.png") && exists("film.0001.png"));
  ASSERT_EQ(run({"render", "film.etd", "--frames", "0:2", "--set", "outputs=[NpyOutput { file: \"g#.npy\" }]"}), 0) << err;
  EXPECT_TRUE(exists("g0.npy") && exists("g1.npy"));
}

TEST_F(SeriesProgramTest, frames_of_one_name_are_refused) {
  EXPECT_EQ(run({"render", "film.etd", "--frames", "0:2", "-o", "a.npy"}), 2);
  EXPECT_TRUE(says("--output: all frames would be written to 'a.npy': write #### where the frame number belongs")) << err;
  EXPECT_EQ(run({"render", "film.etd", "--frames", "0:2", "-o", "a#.npy", "--checkpoint", "state"}), 2);
  EXPECT_TRUE(says("--checkpoint: all frames would write the checkpoint 'state'")) << err;
  folder.write("named.etd", std::string(film).insert(5, "outputs: [PngOutput { file: \"a.png\" }]\n"));
  EXPECT_EQ(run({"render", "named.etd", "--frames", "0:2"}), 2);
  EXPECT_TRUE(says("all frames would be written to 'a.png'")) << err;
  for (const char* wrong : {"3:3", "5:2", "0:9:0", "0", "a:b", "-1:3", "0:1:2:3", "0:9999999999"}) {
    EXPECT_EQ(run({"render", "film.etd", "--frames", wrong, "-o", "a#.npy"}), 2) << wrong;
    EXPECT_TRUE(says("--frames")) << err;
  }
  EXPECT_EQ(run({"render", "film.etd", "--fps", "0"}), 2);
  EXPECT_TRUE(says("--fps")) << err;
  EXPECT_EQ(run({"render", "film.etd", "--frames", "0:2", "--pixel", "1,1"}), 2);
  EXPECT_FALSE(exists("a.npy") || exists("a0.npy"));
}

TEST_F(SeriesProgramTest, whole_frames_are_left_out) {
  const std::vector<std::string> command = {"render", "film.etd", "--frames", "0:4", "-o", "f#.exr", "--skip-existing"};
  ASSERT_EQ(run(command), 0) << err;
  const std::string whole = file_text(folder / "f1.exr");
  std::filesystem::remove(folder / "f0.exr");
  folder.write("f1.exr", whole.substr(0, whole.size() / 2));
  ASSERT_EQ(run({"render", "film.etd", "--frame", "2", "--samples", "1", "-o", "f2.exr"}), 0) << err;
  ASSERT_EQ(run(command), 0) << err;
  EXPECT_TRUE(says("'f1.exr' cannot be read: it is rendered again")) << err;
  EXPECT_TRUE(says("'f2.exr' was rendered from another version of the file or of one that it names, or with other options"))
      << err;
  EXPECT_TRUE(has(out, "f3.exr exists already")) << out;
  EXPECT_TRUE(exists("f0.exr"));
  ASSERT_EQ(run(command), 0) << err;
  for (const char* name : {"f0", "f1", "f2", "f3"}) EXPECT_TRUE(has(out, std::string(name) + ".exr exists already")) << out;
}

TEST_F(SeriesProgramTest, what_files_hold_that_are_included_or_named_counts_too) {
  const auto with_color = [&](const char* color, const char* texel) {
    folder.write("paint.etd", std::string("paint = Lambertian { color: ") + color + " }\n");
    folder.write("texel.ppm", std::string("P3 1 1 255 ") + texel + " 9 9\n");
  };
  with_color("0.5", "8");
  folder.write("part.etd", R"(include "paint.etd"
    Job { renderer: PathTracer { samples: 1 }, camera: PerspectiveCamera { from: [0, 0, 3], to: [0, 0, 0] }
      image: ImageBuffer { width: 4, height: 4 }
      scene: BvhScene { objects: [ Sphere { shader: paint }, Environment { emission: EnvironmentEmission { file: "texel.ppm" } } ] } })");
  const std::vector<std::string> command = {"render", "part.etd", "-o", "p.exr", "--skip-existing"};
  ASSERT_EQ(run(command), 0) << err;
  ASSERT_EQ(run(command), 0) << err;
  EXPECT_TRUE(has(out, "p.exr exists already")) << out;
  for (const auto& [color, texel] : {std::pair("0.4", "8"), std::pair("0.4", "7")}) {
    with_color(color, texel);
    ASSERT_EQ(run(command), 0) << err;
    EXPECT_TRUE(says("'p.exr' was rendered from another version of the file or of one that it names")) << err;
  }
}

TEST_F(SeriesProgramTest, checkpoints_are_of_each_frame) {
  ASSERT_EQ(run({"render", "film.etd", "--frames", "0:2", "-o", "f#.npy", "--continue", "s#"}), 0) << err;
  EXPECT_TRUE(exists("s0") && exists("s1"));
  const std::string before = file_text(folder / "f1.npy");
  ASSERT_EQ(run({"render", "film.etd", "--frames", "0:2", "-o", "f#.npy", "--continue", "s#"}), 0) << err;
  EXPECT_EQ(file_text(folder / "f1.npy"), before);
  EXPECT_EQ(run({"render", "film.etd", "--frame", "1", "-o", "x.npy", "--resume", "s0"}), 2) << "the state of another frame";
}

TEST_F(SeriesProgramTest, files_follow_each_other_whatever_happens_to_one) {
  folder.write("bad.etd", "Job { sede: 3 }\n");
  folder.write("b.etd", std::string(film).insert(5, "outputs: [PngOutput { file: \"film.png\" }]\n"));
  folder.write("c.etd", film);
  EXPECT_EQ(run({"render", "film.etd", "bad.etd", "b.etd", "c.etd"}), 2);
  EXPECT_TRUE(exists("film.png") && exists("c.png"));
  EXPECT_TRUE(says("Job has no member 'sede' (did you mean 'seed'?)")) << err;
  EXPECT_TRUE(says("'film.png' is already the picture of film.etd")) << err;
  EXPECT_TRUE(says("2 of 4 renders failed:\n  bad.etd\n  b.etd\n")) << err;
  EXPECT_EQ(run({"render", "film.etd", "c.etd", "-o", "a.png"}), 2);
  EXPECT_TRUE(says("pictures of several files cannot be written to one")) << err;
  EXPECT_EQ(run({"render", "film.etd", "c.etd", "--quiet"}), 0) << err;
}

TEST_F(SeriesProgramTest, format_changes_the_layout_alone) {
  folder.write("a.etd", "# one\nJob{camera:none\nscene :none}   # two\n");
  EXPECT_EQ(run({"format", "--check", "a.etd", "film.etd"}), 1) << err;
  EXPECT_EQ(out, "a.etd\nfilm.etd\n");
  EXPECT_EQ(run({"format", "a.etd", "-o", "-"}), 0) << err;
  const std::string neat = "# one\nJob { camera: none\n    scene: none }  # two\n";
  EXPECT_EQ(out, neat);
  EXPECT_EQ(file_text(folder / "a.etd"), "# one\nJob{camera:none\nscene :none}   # two\n");
  EXPECT_EQ(run({"format", "a.etd"}), 0) << err;
  EXPECT_EQ(file_text(folder / "a.etd"), neat);
  EXPECT_EQ(run({"format", "--check", "a.etd"}), 0) << err;
  folder.write("wrong.etd", "Job { camera: [1 }\n");
  EXPECT_EQ(run({"format", "wrong.etd", "a.etd"}), 2);
  EXPECT_EQ(file_text(folder / "wrong.etd"), "Job { camera: [1 }\n");
  EXPECT_EQ(run({"format", "x.json"}), 2);
  EXPECT_EQ(run({"format", "a.etd", "film.etd", "-o", "b.etd"}), 2);
}

}  // namespace
}  // namespace etendue
