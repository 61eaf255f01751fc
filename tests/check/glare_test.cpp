// Glare of pictures that are computed here pixel by pixel, against the formulas by hand.

#include "check/measure/glare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "etendue/film/image_tools.h"
#include "support/program_support.h"

namespace etendue {
namespace {

using measure::FisheyeMapping;
using measure::Glare;
using measure::GlareOptions;

constexpr double exact_pi = 3.14159265358979323846, degree = exact_pi / 180;

/// A picture of a function of the direction, x to the right, y upwards, z forwards [cd/m2]; only for the mappings used here.
Image picture_of(FisheyeMapping mapping, int height, const std::function<double(double, double, double)>& luminance) {
  const int width = mapping == FisheyeMapping::equirectangular ? 2 * height : height;
  const double scale = 683 * observer_y_integral();
  Image image(width, height, {"X", "Y", "Z"});
  image.metadata["color_space"] = "xyz";
  for (int i = 0; i < width; ++i)
    for (int j = 0; j < height; ++j) {
      const double u = (i + 0.5) / width, v = (j + 0.5) / height;
      double x = 0, y = 0, z = 0;
      if (mapping == FisheyeMapping::equirectangular) {
        const double l = 2 * exact_pi * (u - 0.5), t = exact_pi * v;
        x = std::sin(t) * std::sin(l), y = std::cos(t), z = std::sin(t) * std::cos(l);
      } else {
        const double a = 2 * u - 1, b = 1 - 2 * v, r = std::hypot(a, b);
        if (r >= 1) continue;
        const double t = mapping == FisheyeMapping::angular ? r * exact_pi / 2 : std::asin(r);
        x = std::sin(t) * a / r, y = std::sin(t) * b / r, z = std::cos(t);
      }
      for (size_t c = 0; c < 3; ++c) image.at(i, j, c) = luminance(x, y, z) / scale;
    }
  return image;
}

/// A disc of the half angle `half` seen at an azimuth and elevation [deg], before a uniform background [cd/m2].
struct Lamp {
  double azimuth, elevation, half, luminance, background;

  double operator()(double x, double y, double z) const {
    return x * cx() + y * cy() + z * cz() > std::cos(half * degree) ? luminance : background;
  }
  double cx() const { return std::sin(azimuth * degree) * std::cos(elevation * degree); }
  double cy() const { return std::sin(elevation * degree); }
  double cz() const { return std::cos(azimuth * degree) * std::cos(elevation * degree); }
  double solid_angle() const { return 2 * exact_pi * (1 - std::cos(half * degree)); }
  /// On the plane of the eye: L pi sin^2(half) cos(angle from the view direction).
  double illuminance(double l) const { return l * exact_pi * std::pow(std::sin(half * degree), 2) * cz(); }
};

// By hand, with s = 20 deg straight above: t = 0, ln P = (35.2 - 1.22) 1e-3 s + 21e-5 s^2 = 0.6796 + 0.084.
TEST(Glare, PositionIndex) {
  EXPECT_NEAR(measure::position_index(0, 0), 1, 1e-12);
  EXPECT_NEAR(measure::position_index(0, 20), std::exp(0.7636), 1e-9);
  // To the side, t = 90: (35.2 - 28.7001 - 1.22 e^-20) 1e-3 s + (21 + 24.0003 - 24.0003) 1e-5 s^2.
  EXPECT_NEAR(measure::position_index(30, 0), std::exp(6.4999e-3 * 30 + 21e-5 * 900), 1e-6);
  EXPECT_NEAR(measure::position_index(-30, 0), measure::position_index(30, 0), 1e-12);
  // Below: 1 + 0.8 tan(20 deg), 1 + 1.2 tan(40 deg), and no more than at three times the distance.
  EXPECT_NEAR(measure::position_index(0, -20), 1 + 0.8 * std::tan(20 * degree), 1e-9);
  EXPECT_NEAR(measure::position_index(0, -40), 1 + 1.2 * std::tan(40 * degree), 1e-9);
  EXPECT_NEAR(measure::position_index(10, -80), 4.6, 1e-9);
  EXPECT_EQ(measure::position_index(0, 80), 16);
}

TEST(Glare, OneDiscBeforeAUniformBackground) {
  for (const FisheyeMapping mapping : {FisheyeMapping::equirectangular, FisheyeMapping::angular, FisheyeMapping::hemispherical})
    for (const Lamp& lamp : {Lamp{0, 20, 6, 20000, 400}, Lamp{-35, 10, 8, 9000, 300}, Lamp{15, -25, 10, 6000, 500}}) {
      GlareOptions options;
      options.mapping = mapping;
      const Glare g = measure::glare_of(picture_of(mapping, 400, lamp), options);
      const double behind = lamp.background * exact_pi - lamp.illuminance(lamp.background);  // lx, beside the lamp
      const double ev = behind + lamp.illuminance(lamp.luminance);
      const double p = measure::position_index(lamp.azimuth, lamp.elevation);
      const double sum = lamp.luminance * lamp.luminance * lamp.solid_angle() / (p * p);
      ASSERT_EQ(g.sources.size(), 1u);
      EXPECT_NEAR(g.covered, 2 * exact_pi, 0.02);
      EXPECT_NEAR(g.illuminance, ev, 5e-3 * ev);
      EXPECT_NEAR(g.background, behind / exact_pi, 3e-3 * behind / exact_pi);
      EXPECT_NEAR(g.sources[0].luminance, lamp.luminance, 1e-6 * lamp.luminance);
      EXPECT_NEAR(g.sources[0].solid_angle, lamp.solid_angle(), 1.5e-2 * lamp.solid_angle());
      EXPECT_NEAR(g.sources[0].azimuth, lamp.azimuth, 0.05);
      EXPECT_NEAR(g.sources[0].elevation, lamp.elevation, 0.05);
      EXPECT_NEAR(g.sources[0].position_index, p, 0.01);
      EXPECT_NEAR(g.ugr, 8 * std::log10(0.25 * exact_pi / behind * sum), 0.08);
      EXPECT_NEAR(g.dgp, 5.87e-5 * ev + 0.0918 * std::log10(1 + sum / std::pow(ev, 1.87)) + 0.16, 1e-3);
    }
}

// A lamp behind the left edge of the picture is in front when the eye is turned there; one source, though the edge cuts it.
TEST(Glare, TheViewTurns) {
  const Image image = picture_of(FisheyeMapping::equirectangular, 360, Lamp{180, 15, 8, 20000, 100});
  EXPECT_TRUE(measure::glare_of(image, {}).sources.empty());
  EXPECT_EQ(measure::glare_of(image, {}).ugr, -std::numeric_limits<double>::infinity());
  const Glare g = measure::glare_of(image, {.yaw = 170, .pitch = 15});
  ASSERT_EQ(g.sources.size(), 1u);
  // Rotated: the lamp is 10 degrees of longitude to the right of the view direction, at the latitude 15.
  const double x = std::sin(10 * degree) * std::cos(15 * degree);
  EXPECT_NEAR(g.sources[0].azimuth, std::atan2(x, std::sqrt(1 - x * x)) / degree, 0.1);
  EXPECT_NEAR(g.sources[0].elevation, 0.22, 0.1);
}

// The sun in a window is a source of its own, the blurred edge of a lamp is not.
TEST(Glare, Peaks) {
  const Lamp window{0, 10, 15, 8000, 200}, sun{0, 10, 2, 1e6, 0};
  const auto both = [&](double x, double y, double z) { return std::max(window(x, y, z), sun(x, y, z)); };
  const Image image = picture_of(FisheyeMapping::equirectangular, 360, both);
  const Glare g = measure::glare_of(image, {.threshold = 2000});
  ASSERT_EQ(g.sources.size(), 2u);
  EXPECT_NEAR(g.sources[0].luminance, 1e6, 1);
  EXPECT_NEAR(g.sources[1].luminance, 8000, 1e-3);
  EXPECT_EQ(measure::glare_of(image, {.threshold = 2000, .peak = 0}).sources.size(), 1u);

  const Lamp bright{0, 10, 5, 1e5, 200}, edge{0, 10, 5.4, 4e4, 200};
  const Image blurred = picture_of(FisheyeMapping::equirectangular, 360,
                                   [&](double x, double y, double z) { return std::max(bright(x, y, z), edge(x, y, z)); });
  EXPECT_EQ(measure::glare_of(blurred, {.threshold = 2000}).sources.size(), 1u);
}

TEST(Glare, Refuses) {
  const Image square = picture_of(FisheyeMapping::angular, 20, Lamp{0, 0, 10, 1000, 10});
  EXPECT_THROW(measure::glare_of(square, {}), Error);
  EXPECT_THROW(measure::glare_of(square, {.mapping = FisheyeMapping::angular, .yaw = 5}), Error);
  Image bad = square;
  bad.at(10, 10, 1) = std::nan("");
  EXPECT_THROW(measure::glare_of(bad, {.mapping = FisheyeMapping::angular}), Error);
  EXPECT_THROW(measure::glare_of(Image(20, 20, {"X", "Y", "Z"}), {.mapping = FisheyeMapping::angular}), Error);
  const Glare dark = measure::glare_of(square, {.mapping = FisheyeMapping::angular, .angle = 90});
  ASSERT_FALSE(dark.notes.empty());  // a part of what is in front is missing
  EXPECT_NE(measure::glare_text(dark).find("covers"), std::string::npos);
}

using GlareProgram = RunsProgram;

TEST_F(GlareProgram, PrintsTableAndJson) {
  const Lamp lamp{0, 20, 6, 20000, 400};
  write_any(picture_of(FisheyeMapping::equirectangular, 64, lamp), folder / "wide.exr");
  write_any(picture_of(FisheyeMapping::angular, 64, lamp), folder / "round.exr");
  EXPECT_EQ(run({"image", "glare", "wide.exr"}), 0) << err;
  EXPECT_TRUE(has(out, "UGR ") && has(out, "DGP ") && has(out, "position index")) << out;
  EXPECT_NE(run({"image", "glare", "round.exr"}), 0);
  EXPECT_TRUE(says("--mapping")) << err;
  EXPECT_EQ(run({"image", "glare", "round.exr", "--mapping", "angular", "--json"}), 0) << err;
  EXPECT_TRUE(has(out, "\"dgp\": 0.31")) << out;
}

}  // namespace
}  // namespace etendue
