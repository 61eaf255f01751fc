// Mistakes in options are reported at the option, and options without effect are refused.

#include <gtest/gtest.h>
#include <unistd.h>

#include "support/program_support.h"

namespace etendue {
namespace {

const char* const scene_text = R"(Job {
    renderer: PathTracer { samples: 1 }
    camera:   PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 45 deg }
    image:    ImageBuffer { width: 8, height: 8 }
    scene:    BvhScene { objects: [
        ball
        Sphere { radius: 0.5 m, transform: translate(0, 2 m, -1 m), emission: DiffuseEmission { radiance: 5 } }
    ] }
    outputs:  [PngOutput { file: "named.png" }]
}
ball = Sphere { radius: 1 m, shader: Lambertian { color: 0.5 } }
)";

class OptionErrors : public RunsProgram {
 protected:
  void SetUp() override { scene = folder.write("ball.etd", scene_text); }
  /// The error message of a render with these options, which must be refused.
  std::string refused(std::vector<std::string> options) {
    options.insert(options.begin(), {"render", scene});
    EXPECT_EQ(run(options), 2) << err;
    return err;
  }

  std::string scene;
};

TEST_F(OptionErrors, StandAtTheOptionThatWasGiven) {
  EXPECT_TRUE(refused({"-o", "no/h.png"}).starts_with("--output: ")) << err;
  EXPECT_TRUE(refused({"--crop", "5,5,2,2"}).starts_with("--crop: ")) << err;
  EXPECT_TRUE(refused({"--samples", "many"}).starts_with("--samples: ")) << err;
  EXPECT_TRUE(refused({"--samples", "0"}).starts_with("--samples: ")) << err;
  EXPECT_TRUE(refused({"--samples", "1 +"}).starts_with("--samples: ")) << err;
  EXPECT_TRUE(refused({"--error", "-1"}).starts_with("--error: ")) << err;
  EXPECT_TRUE(refused({"--error", "2%"}).starts_with("--error: '2%' is written 0.02\n")) << err;
  EXPECT_EQ(err.find("--set"), std::string::npos) << err;
}

TEST_F(OptionErrors, WhatMeansNothingIsRefused) {
  EXPECT_TRUE(has(refused({"--pixel", "1,1", "-o", "a.png"}), "--output")) << err;
  EXPECT_TRUE(has(refused({"--pixel", "1,1", "--skip-existing"}), "--skip-existing")) << err;
  EXPECT_TRUE(has(refused({"--allow-path", "nowhere"}), "--allow-path: 'nowhere' is not a folder")) << err;
  EXPECT_EQ(run({"nonsense", "--help"}), 2);
  EXPECT_TRUE(says("there is no command 'nonsense'")) << err;
  EXPECT_EQ(run({"rendr", "--help"}), 2);
  EXPECT_TRUE(says("did you mean 'render'?")) << err;
  EXPECT_EQ(run({"verify", scene, "--renderers", "PathTracer,PathTracer"}), 2);
  EXPECT_TRUE(says("--renderers: 'PathTracer' is named twice")) << err;
}

TEST_F(OptionErrors, DescriptionsAreNotWrittenByOtherNames) {
  EXPECT_EQ(run({"save", scene, "-o", folder / "box.pbrt"}), 2);
  EXPECT_TRUE(says("--output: ")) << err;
  EXPECT_TRUE(says("ends in .etd or .json; 'etendue export' writes .pbrt")) << err;
  EXPECT_EQ(run({"save", scene, "-o", folder / "box.png"}), 2);
  EXPECT_TRUE(says("the name of a description ends in .etd or .json\n")) << err;
  for (const char* name : {"box.pbrt", "box.png"}) EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
  EXPECT_EQ(run({"save", scene, "-o", folder / "box.json"}), 0) << err;
}

TEST_F(OptionErrors, WhatALaterOneWouldUndoIsRefused) {
  EXPECT_TRUE(refused({"--set", "renderer.max_depth=2", "--set", "renderer=LightTracer"})
                  .starts_with("--set: 'renderer' would overwrite what --set sets in 'renderer.max_depth'"))
      << err;
  EXPECT_TRUE(refused({"--set", "scene.objects[0].shader.color=0.2", "--set", "scene.objects[0].shader=PhongShader"})
                  .starts_with("--set: 'scene.objects[0].shader' would overwrite"))
      << err;
  EXPECT_TRUE(refused({"--set", "seed=3", "--seed", "4"}).starts_with("--seed: 'seed' is set already, by --set")) << err;
  EXPECT_TRUE(refused({"--set", "image.width=4", "--size", "8x8"}).starts_with("--size: 'image.width' is set already")) << err;
  EXPECT_TRUE(refused({"--fps", "30"}).starts_with("--fps: there are no frames")) << err;
  EXPECT_EQ(run({"render", scene, "--set", "renderer=LightTracer", "--set", "renderer.max_depth=2", "--samples", "1", "--set",
                 "renderer.roulette_depth=3"}),
            0)
      << err;
}

TEST_F(OptionErrors, ARendererIsNamedAndKeepsWhatTheFileSays) {
  EXPECT_TRUE(has(refused({"--renderer", "PathTracr"}), "did you mean 'PathTracer'?")) << err;
  EXPECT_TRUE(has(refused({"--renderer", "Sphere"}), "'Sphere' is no renderer")) << err;
  EXPECT_TRUE(refused({"--renderer", "LightTracer", "--set", "renderer=PathTracer"})
                  .starts_with("--set: 'renderer' is set already, by --renderer"))
      << err;
  // max_depth and samples of the file, unless the expression or a later option sets them.
  const auto same_picture = [&](const char* renderer, std::vector<std::string> sets) {
    EXPECT_EQ(run({"render", scene, "--renderer", renderer, "--quiet", "-o", "named.npy"}), 0) << err;
    std::vector<std::string> plain{"render", scene, "--quiet", "-o", "plain.npy"};
    plain.insert(plain.end(), sets.begin(), sets.end());
    EXPECT_EQ(run(plain), 0) << err;
    return file_text(folder.path() + "/named.npy") == file_text(folder.path() + "/plain.npy");
  };
  const std::string depth = "renderer.max_depth=3";
  EXPECT_EQ(run({"save", scene, "--set", "renderer.samples=3", "--set", depth, "-o", "deep.etd"}), 0) << err;
  scene = folder.path() + "/deep.etd";
  EXPECT_TRUE(same_picture("LightTracer", {"--set", "renderer=LightTracer { max_depth: 3, samples: 3 }"}));
  EXPECT_FALSE(same_picture("LightTracer { max_depth: 1 }", {"--set", "renderer=LightTracer { max_depth: 3, samples: 3 }"}));
}

TEST_F(OptionErrors, APathGoesByMembers) {
  EXPECT_TRUE(
      has(refused({"--set", "ball.radius=2"}), "a path consists of members, not names of the file; 'ball' is scene.objects[0]"))
      << err;
}

TEST_F(OptionErrors, APictureLargerThanTheMemoryIsRefusedAtOnce) {
  // A picture needs at least 64 bytes per pixel.
  if (double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE)) > 65536. * 65536. * 64)
    GTEST_SKIP() << "this machine's memory holds such a picture";
  EXPECT_TRUE(has(refused({"--size", "65536x65536"}), "more than the")) << err;
}

TEST_F(OptionErrors, PlacesForNumbersNeedFrames) {
  EXPECT_EQ(run({"render", scene, "-o", "h##.png"}), 0) << err;
  EXPECT_TRUE(says("'#' stands for the number of a frame only with --frames")) << err;
  EXPECT_TRUE(has(out, "\n1 sample per pixel in ")) << out;
}

}  // namespace
}  // namespace etendue
