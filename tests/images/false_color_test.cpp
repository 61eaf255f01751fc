// Colours for numbers: the published colour maps, scales and legends.

#include "images/false_color.h"

#include <gtest/gtest.h>

#include <cmath>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "etendue/film/image_tools.h"
#include "images/bitmap_text.h"
#include "support/program_support.h"

namespace etendue {
namespace {

// The first, middle and last of matplotlib's 256 viridis colours: #440154, between #21918c and #20928c, #fde725.
TEST(FalseColor, MapsArePublishedOnes) {
  const auto expect = [](const DisplayColor& c, double r, double g, double b) {
    EXPECT_NEAR(c.r * 255, r, 1.6);
    EXPECT_NEAR(c.g * 255, g, 1.6);
    EXPECT_NEAR(c.b * 255, b, 1.6);
  };
  expect(color_of("viridis", 0), 0x44, 0x01, 0x54);
  expect(color_of("viridis", 0.5), 0x21, 0x91, 0x8c);
  expect(color_of("viridis", 7), 0xfd, 0xe7, 0x25);
  expect(color_of("grey", 0.5), 127.5, 127.5, 127.5);
  EXPECT_THROW(color_of("rainbow", 0.5), Error);
  for (const std::string& name : color_map_names()) EXPECT_NO_THROW(color_of(name, 0.3));
}

TEST(FalseColor, ScalesAndMarks) {
  ColorScale scale;
  scale.low = 1;
  scale.high = 1e4;
  EXPECT_NEAR(scale.position(100), 0.5, 1e-12);
  EXPECT_LT(scale.position(0), 0);
  EXPECT_EQ(scale_marks(scale, 6), (std::vector<double>{1, 10, 100, 1000, 10000}));
  EXPECT_EQ(scale_marks(scale, 2).size(), 2u);
  scale.high = 100;
  EXPECT_EQ(scale_marks(scale, 7).size(), 7u);  // 1 2 5 10 20 50 100
  scale.logarithmic = false;
  scale.low = 0;
  EXPECT_NEAR(scale.position(25), 0.25, 1e-12);
  EXPECT_EQ(scale_marks(scale, 6), (std::vector<double>{0, 20, 40, 60, 80, 100}));
  scale.low = -1e-3;
  scale.high = 2e-3;
  EXPECT_LE(scale_marks(scale, 4).size(), 4u);
}

TEST(FalseColor, RangeOfAPicture) {
  const ColorScale scale = decades_of({3, 40, 2000, 0, -1, std::nan("")}, 4);
  EXPECT_NEAR(scale.low, 1, 1e-9);
  EXPECT_NEAR(scale.high, 1e4, 1e-6);
  EXPECT_NEAR(decades_of({1e-9, 5}, 4).low, 1e-3, 1e-12);  // at most four decades
  EXPECT_NEAR(decades_of({10}, 4).high / decades_of({10}, 4).low, 10, 1e-9);
  EXPECT_THROW(decades_of({0, -3}, 4), Error);
}

TEST(FalseColor, PictureAndLegend) {
  ColorScale scale{"inferno", "cd/m2", 1, 100, true};
  std::vector<double> values(200 * 150, 10);
  values[3] = std::nan("");
  const Image image = false_color(values, 200, 150, scale);
  EXPECT_EQ(image.height, 150);
  EXPECT_GT(image.width, 200 + 50);
  const DisplayColor middle = color_of("inferno", 0.5);
  EXPECT_NEAR(image.at(100, 100, 0), middle.r, 1e-12);
  EXPECT_EQ(image.at(3, 0, 0), 1);  // magenta
  EXPECT_EQ(image.at(3, 0, 1), 0);
  // The bar's ends have the ends' colours, and beside it something is written.
  const int x = 200 + 12;
  const DisplayColor low = color_of("inferno", 0), high = color_of("inferno", 1);
  EXPECT_NEAR(image.at(x, 150 - 12, 0), low.r, 1e-12);
  EXPECT_NEAR(image.at(x, 24, 0), high.r, 1e-12);
  double ink = 0;
  for (int j = 0; j < 150; ++j)
    for (int i = 230; i < image.width; ++i) ink += image.at(i, j, 1);
  EXPECT_GT(ink, 50);
  // A low picture has a whole legend, too.
  EXPECT_GT(false_color({1, 2}, 2, 1, scale).height, 50);
}

TEST(BitmapText, HasInk) {
  EXPECT_TRUE(has_ink("1", 2, 0));
  EXPECT_FALSE(has_ink("1", 5, 0));  // the gap
  EXPECT_TRUE(has_ink("-1", 8, 0));
  EXPECT_FALSE(has_ink("", 0, 0));
  EXPECT_FALSE(has_ink("1", 2, 7));
}

using FalseColorProgram = RunsProgram;

TEST_F(FalseColorProgram, WritesAPicture) {
  Image image(40, 30, {"X", "Y", "Z"});
  image.metadata["color_space"] = "xyz";
  for (double& v : image.values) v = 50 / (683 * observer_y_integral());
  write_any(image, folder / "in.exr");
  EXPECT_EQ(run({"image", "false-colour", "in.exr", "-o", "out.png", "--range", "5:500"}), 0) << err;
  EXPECT_TRUE(has(out, "5 to 500 cd/m2")) << out;
  const Image seen = read_image(folder / "out.png");
  // 50 cd/m2 is in the middle of the scale: viridis 0.5, in the linear values that are read.
  EXPECT_NEAR(seen.at(20, 20, 1), std::pow((0.5686 + 0.055) / 1.055, 2.4), 0.01);
  EXPECT_NE(run({"image", "false-colour", "in.exr", "-o", "out.png", "--range", "5"}), 0);
  EXPECT_TRUE(says("--range")) << err;
  EXPECT_NE(run({"image", "false-colour", "in.exr", "-o", "out.png", "--range", "0:9"}), 0);
  EXPECT_NE(run({"image", "false-colour", "in.exr", "-o", "out.exr"}), 0);
  EXPECT_NE(run({"image", "false-colour", "in.exr", "-o", "out.png", "--channel", "depth"}), 0);
}

}  // namespace
}  // namespace etendue
