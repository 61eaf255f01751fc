// The option --denoise of the program.

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "etendue/film/image_tools.h"
#include "support/program_support.h"

namespace etendue {
namespace {

const char* const lamp = R"(Job {
    renderer: PathTracer { samples: 2 }
    camera: PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m, fov: 45 deg }
    image: ImageBuffer { width: 20, height: 16, filter: BoxFilter {} }
    scene: BruteForceScene { objects: [ Sphere { radius: 0.5 m, emission: DiffuseEmission { radiance: 5 } } ] }
    outputs: [ OUTPUT ]
}
)";

class DenoiseProgramTest : public RunsProgram {
 protected:
  void SetUp() override { describe("PngOutput {}"); }
  void TearDown() override { setenv("ETENDUE_OIDN", before_.c_str(), 1); }
  void describe(const std::string& output) {
    std::string text = lamp;
    folder.write("lamp.etd", text.replace(text.find("OUTPUT"), 6, output));
  }
  /// Whether the library Open Image Denoise is found; if not, the test is skipped.
  bool there() {
    const bool found = run({"render", "lamp.etd", "--denoise", "-o", "probe.png"}) == 0;
    return found;
  }
  static std::string set() {
    const char* value = std::getenv("ETENDUE_OIDN");
    return value ? value : "";
  }
  const std::string before_ = set();
};

TEST_F(DenoiseProgramTest, WithoutTheLibraryItIsSaidAtOnceHowToGetIt) {
  setenv("ETENDUE_OIDN", "/nowhere/libOpenImageDenoise.so.2", 1);
  EXPECT_EQ(run({"render", "lamp.etd", "--denoise", "-o", "a.png"}), 2);
  EXPECT_TRUE(says("/nowhere/libOpenImageDenoise.so.2") && says("pip install pyoidn") && says("ETENDUE_OIDN")) << err;
  EXPECT_FALSE(exists("a.png")) << "it was rendered first";
  describe("DenoisedOutput {}");
  EXPECT_EQ(run({"render", "lamp.etd"}), 2);
  EXPECT_TRUE(says("lamp.etd:6")) << err;
  // An existing library that is not Open Image Denoise.
  setenv("ETENDUE_OIDN", "libm.so.6", 1);
  EXPECT_EQ(run({"render", "lamp.etd", "--denoise", "-o", "a.png"}), 2);
  EXPECT_TRUE(says("no Open Image Denoise of version 2")) << err;
}

TEST_F(DenoiseProgramTest, TheRawPictureIsKept) {
  if (!there()) GTEST_SKIP() << err;
  ASSERT_EQ(run({"render", "lamp.etd", "-o", "raw.npy", "-o", "raw.exr"}), 0) << err;
  ASSERT_EQ(run({"render", "lamp.etd", "--denoise", "-o", "a.npy", "-o", "a.exr", "-o", "a.png", "--progress", "json"}), 0)
      << err;
  EXPECT_EQ(file_text(folder / "a.npy"), file_text(folder / "raw.npy"));
  ASSERT_TRUE(exists("a.denoised.npy") && exists("a.denoised.exr") && exists("a.denoised.png"));
  EXPECT_NE(file_text(folder / "a.denoised.npy"), file_text(folder / "a.npy"));
  const std::string last = out.substr(out.rfind('{'));
  const auto json = nlohmann::json::parse(last);
  EXPECT_EQ(json["outputs"], (nlohmann::json{"a.npy", "a.exr", "a.png"}));
  EXPECT_EQ(json["denoised"], (nlohmann::json{"a.denoised.npy", "a.denoised.exr", "a.denoised.png"}));
  for (const char* ending : {"exr", "png"}) {
    const Image second = read_image(folder / ("a.denoised." + std::string(ending))),
                first = read_image(folder / ("a." + std::string(ending)));
    EXPECT_TRUE(has(second.metadata.at("bias"), "denoised")) << ending;
    EXPECT_TRUE(has(second.metadata.at("denoiser"), "Open Image Denoise 2.")) << second.metadata.at("denoiser");
    EXPECT_FALSE(first.metadata.contains("bias") || first.metadata.contains("denoiser")) << ending;
  }
}

TEST_F(DenoiseProgramTest, DescriptionsAskForIt) {
  if (!there()) GTEST_SKIP() << err;
  describe("DenoisedOutput { output: NpyOutput {}, denoiser: OpenImageDenoiser { guide_samples: 4, quality: \"fast\" } }");
  ASSERT_EQ(run({"render", "lamp.etd"}), 0) << err;
  EXPECT_TRUE(exists("lamp.npy") && exists("lamp.denoised.npy"));
  EXPECT_FALSE(says("BoxFilter")) << err;
  // The settings of a DenoisedOutput also apply to other files of the same format.
  ASSERT_EQ(run({"render", "lamp.etd", "-o", "b.npy", "-o", "b.png", "--set", "image.filter=TriangleFilter"}), 0) << err;
  EXPECT_TRUE(says("noise will stay") && says("BoxFilter")) << err;
  EXPECT_TRUE(exists("b.npy") && exists("b.denoised.npy") && exists("b.png"));
  EXPECT_FALSE(exists("b.denoised.png"));
  ASSERT_EQ(run({"render", "lamp.etd", "-o", "b.npy"}), 0) << err;
  ASSERT_EQ(run({"render", "lamp.etd", "-o", "b.npy", "--skip-existing"}), 0) << err;
  EXPECT_TRUE(has(out, "b.denoised.npy") && has(out, "exists already")) << out;
  std::filesystem::remove(folder / "b.denoised.npy");
  ASSERT_EQ(run({"render", "lamp.etd", "-o", "b.npy", "--skip-existing"}), 0) << err;
  EXPECT_TRUE(exists("b.denoised.npy"));
  // Two pictures would be written to the same name.
  EXPECT_EQ(run({"render", "lamp.etd", "--denoise", "-o", "c.npy", "-o", "c.denoised.npy"}), 2);
  EXPECT_TRUE(says("c.denoised.npy")) << err;
}

}  // namespace
}  // namespace etendue
