// Tone operators that begin with an exposure, against published numbers and closed forms; and contents of pictures that
// automatic exposure must cope with: fireflies, lamps, black backgrounds, a sky.

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "etendue/describe/color.h"
#include "etendue/exposed_tone_map.h"
#include "etendue/film/image_tools.h"
#include "etendue/language/language.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using Rgb = std::array<double, 3>;

Ref<ToneMap> tone_map(const std::string& text) {
  Ref<ToneMap> map = ref_cast<ToneMap>(parse_component(text));
  map->prepare();
  return map;
}

Image colored(const std::vector<Rgb>& colors, int width = 0) {
  if (width == 0) width = int(colors.size());
  Image image(width, int(colors.size()) / width, {"X", "Y", "Z"});
  image.metadata["color_space"] = "xyz";
  const std::array<double, 9> m = rgb_space("srgb").to_xyz;
  for (size_t i = 0; i < colors.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      image.values[3 * i + c] = m[3 * c] * colors[i][0] + m[3 * c + 1] * colors[i][1] + m[3 * c + 2] * colors[i][2];
  return image;
}

Image grey(const std::vector<double>& values, int width = 0) {
  std::vector<Rgb> colors;
  for (const double v : values) colors.push_back({v, v, v});
  return colored(colors, width);
}

/// The tone mapped value of a colour in linear sRGB.
Rgb shown(const Ref<ToneMap>& map, const Rgb& color) {
  const Image out = map->apply(colored({color}));
  return {out.values[0], out.values[1], out.values[2]};
}

// ---- AgX ---------------------------------------------------------------------------------------------------------------

/// The published polynomial for the sigmoid with slope 2 (Wrensch 2023; its mean squared error is 3.7e-6).
double published_sigmoid(double light) {
  const double x = (std::clamp(std::log2(std::max(light, 1e-10)), -12.47393, 4.026069) + 12.47393) / (4.026069 + 12.47393);
  return ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x) - 0.00232;
}

TEST(AgX, GreysAreThoseOfThePublishedCurve) {
  const auto map = tone_map("AgXToneMap { exposure: fixed, contrast: 2, transfer: \"gamma2.2\" }");
  for (double stops = -10; stops <= 6.5; stops += 0.25) {
    const double light = 0.18 * std::exp2(stops);
    EXPECT_NEAR(shown(map, {light, light, light})[1], published_sigmoid(light), 0.006) << stops;
  }
  EXPECT_NEAR(shown(map, {1e9, 1e9, 1e9})[0], 1, 1e-9);
}

TEST(AgX, MiddleGreyIsHalfTheCodeValues) {
  for (const char* contrast : {"1.3", "2", "2.6", "6"}) {
    const auto map =
        tone_map(std::string("AgXToneMap { exposure: fixed, transfer: \"gamma2.2\", contrast: ") + contrast + " }");
    EXPECT_NEAR(shown(map, {0.18, 0.18, 0.18})[1], 0.5, 1e-6) << contrast;
  }
  // With the default contrast, contrasts near middle grey are those of the scene.
  const auto light = tone_map("AgXToneMap { exposure: fixed, transfer: \"linear\" }");
  const double up = shown(light, {0.185, 0.185, 0.185})[1], down = shown(light, {0.175, 0.175, 0.175})[1];
  EXPECT_NEAR(std::log(up / down) / std::log(0.185 / 0.175), 1, 0.002);
}

TEST(AgX, ColorsAreThoseOfThePublishedMatrices) {
  constexpr double inset[3][3] = {{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                  {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                  {0.0423756549057051, 0.0784336, 0.879142973793104}};
  constexpr double outset[3][3] = {{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                                   {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                                   {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}};
  const auto map = tone_map("AgXToneMap { exposure: fixed, contrast: 2, transfer: \"gamma2.2\" }");
  for (const Rgb& color :
       {Rgb{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.2, 0.05}, {0.02, 0.3, 0.9}, {8, 2, 0.1}, {0.01, 0.02, 0.03}}) {
    Rgb bent, expected;
    for (size_t i = 0; i < 3; ++i)
      bent[i] = published_sigmoid(inset[i][0] * color[0] + inset[i][1] * color[1] + inset[i][2] * color[2]);
    for (size_t i = 0; i < 3; ++i)
      expected[i] = std::clamp(outset[i][0] * bent[0] + outset[i][1] * bent[1] + outset[i][2] * bent[2], 0.0, 1.0);
    const Rgb found = shown(map, color);
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 0.008) << color[0] << ' ' << color[1] << ' ' << color[2];
  }
}

TEST(AgX, BrightColorsGoToWhite) {
  const auto map = tone_map("AgXToneMap { exposure: fixed }");
  for (const Rgb& hue : {Rgb{1, 0, 0}, {0, 0.5, 0}, {0.1, 0.1, 1}}) {
    double paleness = 0;
    for (double scale = 1; scale < 2000; scale *= 2) {
      const Rgb c = shown(map, {scale * hue[0], scale * hue[1], scale * hue[2]});
      const double now = std::min({c[0], c[1], c[2]}) / std::max({c[0], c[1], c[2]});
      EXPECT_GE(now, paleness - 1e-9);
      paleness = now;
    }
    EXPECT_GT(paleness, 0.99);
  }
  // A spectral green of 530 nm, outside sRGB's gamut, keeps a little of all components.
  const Xyz green = observer(530);
  Image in(1, 1, {"X", "Y", "Z"});
  in.values = {0.5 * green.x, 0.5 * green.y, 0.5 * green.z};
  const Image out = map->apply(in), clipped = tone_map("ExposureToneMap {}")->apply(in);
  EXPECT_EQ(clipped.values[0], 0);
  EXPECT_GT(out.values[1], out.values[0] + 0.1);
  EXPECT_LT(out.values[1], 1);
}

// ---- ACES ---------------------------------------------------------------------------------------------------------------

TEST(Aces, ValuesAreThoseOfThePublishedFit) {
  constexpr double in[3][3] = {{0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}};
  constexpr double out[3][3] = {{1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}};
  const auto map = tone_map("AcesToneMap { exposure: fixed, transfer: \"linear\" }");
  // By hand: 0.18 (0.18 + 0.0245786) - 0.000090537 = 0.0367336 over 0.18 (0.1770712 + 0.432951) + 0.238081 = 0.3478850.
  EXPECT_NEAR(shown(map, {0.18, 0.18, 0.18})[1], 0.105591, 2e-5);
  EXPECT_NEAR(shown(map, {1, 1, 1})[1], 1.024488 / 1.654761, 2e-5);
  for (const Rgb& color : {Rgb{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.2, 0.05}, {0.02, 0.3, 0.9}, {8, 2, 0.1}}) {
    Rgb bent, expected;
    for (size_t i = 0; i < 3; ++i) {
      const double v = in[i][0] * color[0] + in[i][1] * color[1] + in[i][2] * color[2];
      bent[i] = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    }
    for (size_t i = 0; i < 3; ++i)
      expected[i] = std::clamp(out[i][0] * bent[0] + out[i][1] * bent[1] + out[i][2] * bent[2], 0.0, 1.0);
    const Rgb found = shown(map, color);
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 1e-4) << color[0] << ' ' << color[1] << ' ' << color[2];
  }
}

// ---- Reinhard -----------------------------------------------------------------------------------------------------------

TEST(Reinhard, EquationFourByHand) {
  const auto map = tone_map("ReinhardToneMap { exposure: fixed, white: 4, transfer: \"linear\" }");
  // L (1 + L / 16) / (1 + L)
  for (const auto& [l, expected] : {std::pair{0.18, 0.18 * 1.01125 / 1.18}, {1.0, 0.53125}, {4.0, 1.0}, {9.0, 1.0}})
    EXPECT_NEAR(shown(map, {l, l, l})[1], expected, 1e-9) << l;
  // The white is found automatically: 99.5 % of 4000 pixels do not exceed 8.
  std::vector<double> values(4000, 2.0);
  std::fill_n(values.begin() + 3, 30, 8.0);
  values[35] = values[40] = 1e7;
  const Image out = tone_map("ReinhardToneMap { exposure: fixed, transfer: \"linear\" }")->apply(grey(values));
  EXPECT_NEAR(out.values[0], 2 * (1 + 2.0 / 64) / 3, 1e-9);
  EXPECT_NEAR(out.values[9], 1, 1e-9);
}

TEST(Reinhard, ColorsAreMixedWithGreyOfTheirLuminance) {
  const auto map = tone_map("ReinhardToneMap { exposure: fixed, white: 100, transfer: \"linear\" }");
  const RgbSpace& srgb = rgb_space("srgb");
  const double red = srgb.to_xyz[3], green = srgb.to_xyz[4], blue = srgb.to_xyz[5];
  for (const Rgb& color : {Rgb{20, 0.1, 0.1}, {0.3, 0.2, 0.1}, {0, 0, 30}, {1, -0.3, 0.5}}) {
    const double l = red * color[0] + green * color[1] + blue * color[2], expected = l * (1 + l / 1e4) / (1 + l);
    const Rgb c = shown(map, color);
    EXPECT_NEAR(red * c[0] + green * c[1] + blue * c[2], expected, 1e-9);
    // The result lies on the line from grey to the colour: all three components approach grey by the same factor.
    const double s = expected / l, kept = (c[0] - expected) / (s * color[0] - expected);
    EXPECT_NEAR((c[1] - expected) / (s * color[1] - expected), kept, 1e-9);
    EXPECT_NEAR((c[2] - expected) / (s * color[2] - expected), kept, 1e-9);
    EXPECT_TRUE(kept > 0 && kept <= 1 + 1e-12);
  }
}

TEST(Reinhard, LocalKeepsDetailsThatGlobalFlattens) {
  const char* members = "{ exposure: fixed, white: 1e9, transfer: \"linear\" }";
  const auto local = tone_map(std::string("ReinhardLocalToneMap ") + members),
             global = tone_map(std::string("ReinhardToneMap ") + members);
  // Of a uniform image both give L / (1 + L).
  EXPECT_NEAR(local->apply(grey(std::vector<double>(100, 3.0), 10)).values[150], 0.75, 1e-9);
  // Stripes of 2 % on a bright ground: the local mean is that of the ground, so the stripes keep their contrast: L / (1 +
  // mean).
  constexpr int side = 96;
  std::vector<double> stripes;
  for (int i = 0; i < side * side; ++i) stripes.push_back(20 * (i % 2 ? 1.01 : 0.99));
  const Image a = local->apply(grey(stripes, side)), b = global->apply(grey(stripes, side));
  const size_t middle = 3 * size_t(side * side / 2 + side / 2);
  EXPECT_NEAR(a.values[middle + 3] / a.values[middle], 1.01 / 0.99, 1e-4);
  EXPECT_NEAR(a.values[middle], 20 * 0.99 / 21, 1e-4);
  EXPECT_NEAR(b.values[middle + 3] / b.values[middle], 1 + 0.02 / 20.8, 1e-4);
  // Beside an edge of 100 to 1 the local mean ends at the edge: the dark side makes no halo on the bright one.
  std::vector<double> edge;
  for (int i = 0; i < side * side; ++i) edge.push_back(i % side < side / 2 ? 0.1 : 10);
  const Image c = local->apply(grey(edge, side));
  for (const int x : {2, side / 2 - 2, side / 2 + 1, side - 3}) {
    const double l = x < side / 2 ? 0.1 : 10;
    EXPECT_NEAR(c.values[3 * size_t(side * 40 + x)], l / (1 + l), 0.12 * l / (1 + l)) << x;
  }
}

// ---- Ward's histogram -----------------------------------------------------------------------------------------------------

constexpr double candelas = 683 * 106.856917;

/// Greys whose logarithms are evenly spaced between two luminances [cd/m^2]; a pixel is one degree wide.
Image even(double low, double high, int count = 1800) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(low * std::pow(high / low, (i + 0.5) / count) / candelas);
  return grey(values, 180);
}

TEST(WardHistogram, EvenLogarithmsGiveAPower) {
  const auto map = tone_map("WardHistogramToneMap { ceiling: linear, degrees: 180, transfer: \"linear\" }");
  const Image in = even(5, 5000), out = map->apply(in);
  // ln L_d = ln 1 + ln 100 * P, P = ln(L / 5) / ln 1000: a slope of 2/3, below the ceiling of 1. The ends are smoothed by half
  // a bin.
  for (size_t i = 20; i < 1780; i += 40) {
    const double p = std::log(in.values[3 * i + 1] * candelas / 5) / std::log(1000.0);
    EXPECT_NEAR(out.values[3 * i], (std::pow(100.0, p) - 1) / 99, 0.02 * std::pow(100.0, p) / 99) << i;
  }
}

TEST(WardHistogram, WhatTheDisplayHoldsIsShownAsItIs) {
  const auto map = tone_map("WardHistogramToneMap { ceiling: linear, degrees: 180, transfer: \"linear\" }");
  const Image in = even(10, 200), out = map->apply(in);
  const double white = 10 * std::pow(20.0, 0.99);
  for (size_t i = 0; i < 1780; i += 10)
    EXPECT_NEAR(out.values[3 * i], (100 * in.values[3 * i + 1] * candelas / white - 1) / 99, 0.003) << i;
}

TEST(WardHistogram, OneLuminanceIsShownAsTheScaleFactorSays) {
  const auto map = tone_map("WardHistogramToneMap { transfer: \"linear\" }");
  for (const double l : {3.0, 50.0, 2000.0}) {
    // Ward 1994: ((1.219 + 50^0.4) / (1.219 + L^0.4))^2.5
    const double m = std::pow((1.219 + 4.781762) / (1.219 + std::pow(l, 0.4)), 2.5), value = l / candelas;
    EXPECT_NEAR(shown(map, {value, value, value})[1], std::clamp((m * l - 1) / 99, 0.0, 1.0), 1e-5) << l;
  }
}

TEST(WardHistogram, NoMoreContrastThanTheCeiling) {
  // Two groups of luminances, a room and a window, 300 to 1 apart, with a few pixels between them.
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> values;
  for (int i = 0; i < 3600; ++i) values.push_back((i % 3 ? 20 : 6000) * std::exp(0.25 * normal(random)) / candelas);
  for (int i = 0; i < 180; ++i) values.push_back(5 * std::pow(3000.0, i / 179.0) / candelas);
  const Image in = grey(values, 180);
  /// The largest slope d ln(L_d) / d ln(L) along the ramp.
  const auto slope = [&](const char* ceiling) {
    const Image out =
        tone_map(std::string("WardHistogramToneMap { degrees: 180, transfer: \"linear\", ceiling: ") + ceiling + " }")
            ->apply(in);
    double most = 0;
    for (size_t i = 3600; i + 5 < 3780; ++i)
      most = std::max(most, std::log((1 + 99 * out.values[3 * i + 15]) / (1 + 99 * out.values[3 * i])) /
                                std::log(values[i + 5] / values[i]));
    return most;
  };
  EXPECT_GT(slope("unlimited"), 2);
  EXPECT_LT(slope("linear"), 1.05);
  EXPECT_GT(slope("linear"), 0.8);
}

TEST(WardHistogram, AtNightLessContrastIsShown) {
  const auto map = tone_map("WardHistogramToneMap { degrees: 180, transfer: \"linear\" }");
  const auto contrast = [&](double low) {
    const Image out = map->apply(even(low, 1000 * low));
    return (1 + 99 * out.values[3 * 1750]) / (1 + 99 * out.values[3 * 50]);
  };
  EXPECT_GT(contrast(10), 60);
  EXPECT_LT(contrast(1e-4), 20);
}

// ---- automatic exposure -----------------------------------------------------------------------------------------------------

const char* const exposed[] = {"AgXToneMap",           "AcesToneMap",     "ReinhardToneMap",
                               "ReinhardLocalToneMap", "ExposureToneMap", "WardHistogramToneMap"};

/// Independent pixels whose logarithms are normally distributed with a deviation of 1.5 stops, so with detail of all sizes.
std::vector<double> room(size_t count, double middle) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<double> values;
  for (size_t i = 0; i < count; ++i) values.push_back(middle * std::exp2(1.5 * normal(random)));
  return values;
}

TEST(AutomaticExposure, AFireflyChangesNothingElse) {
  constexpr int side = 128;
  // A local operator averages over surroundings of similar luminance; noise has none, so local operators get a smooth picture
  // with 3 % of the noise.
  std::vector<double> noise = room(side * side, 0.3), smooth = noise;
  for (size_t i = 0; i < smooth.size(); ++i)
    smooth[i] =
        0.3 * std::exp2(2 * std::sin(double(i % side) / 9) * std::sin(double(i / side) / 7)) * std::pow(noise[i] / 0.3, 0.03);
  for (const char* name : exposed) {
    // Ward's histogram gives a part of the display's range to every luminance, also to that of a firefly.
    if (std::string(name) == "WardHistogramToneMap") continue;
    const auto map = tone_map(std::string(name) + " { exposure: automatic, transfer: \"linear\" }");
    const std::vector<double>& values = map->local() ? smooth : noise;
    std::vector<double> with = values;
    with[5 * side + 7] = 1e6;
    const Image a = map->apply(grey(values, side)), b = map->apply(grey(with, side));
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        // A local operator may change pixels near the firefly.
        if (y == 5 && x == 7) continue;
        if (map->local() && x < 7 + 60 && y < 5 + 60) continue;
        const double before = a.at(x, y, 1);
        ASSERT_LT(std::abs(b.at(x, y, 1) - before), 0.01 * std::max(before, 1 / 255.0)) << name << ' ' << x << ' ' << y;
      }
  }
}

double median_code(const Image& image, const std::function<bool(size_t)>& counts) {
  std::vector<double> all;
  for (size_t i = 0; i < image.values.size() / 3; ++i)
    if (counts(i)) all.push_back(image.values[3 * i + 1]);
  std::sort(all.begin(), all.end());
  return all[all.size() / 2];
}

TEST(AutomaticExposure, ALampInViewLeavesTheRoomAsItIs) {
  std::vector<double> values = room(64 * 64, 1e-3);
  const auto map = tone_map("AgXToneMap {}");
  const auto no_lamp = [](size_t i) { return i % 32 != 0; };
  const double before = median_code(map->apply(grey(values, 64)), no_lamp);
  EXPECT_GT(before, 0.4);
  EXPECT_LT(before, 0.65);
  for (size_t i = 0; i < values.size(); i += 32) values[i] = 100;  // 3 % of the picture, 17 stops brighter
  const double after = median_code(map->apply(grey(values, 64)), no_lamp);
  EXPECT_NEAR(after, before, 0.08);
  EXPECT_LT(median_code(tone_map("NormalizeToneMap {}")->apply(grey(values, 64)), no_lamp), 0.01);  // else the room is black
}

TEST(AutomaticExposure, BlackAroundAThingDoesNotCount) {
  std::vector<double> values = room(64 * 64, 5);
  const auto thing = [](size_t i) { return i % 10 == 0; };
  const auto map = tone_map("AgXToneMap {}");
  const double alone = median_code(map->apply(grey(values, 64)), thing);
  for (const double black : {0.0, 1e-9, 1e-4}) {
    for (size_t i = 0; i < values.size(); ++i)
      if (!thing(i)) values[i] = black;
    EXPECT_NEAR(median_code(map->apply(grey(values, 64)), thing), alone, 0.06) << black;
  }
}

TEST(AutomaticExposure, SkyAndGroundBothShow) {
  // The upper half is a sky of 4 to 16 with a sun of 1e5, the lower half ground in sunlight and in shadow.
  constexpr int side = 64;
  for (const double scale : {1e-5, 1.0, 300.0}) {
    std::vector<double> values = room(side * side, 1);
    for (size_t i = 0; i < values.size() / 2; ++i) values[i] = 4 + 12 * double(i) / double(values.size() / 2);
    for (const size_t sun : {200u, 201u, 264u, 265u}) values[sun] = 1e5;
    for (double& v : values) v *= scale;
    const Image out = tone_map("AgXToneMap {}")->apply(grey(values, side));
    const double sky = median_code(out, [](size_t i) { return i < side * side / 2; });
    const double ground = median_code(out, [](size_t i) { return i >= side * side / 2; });
    EXPECT_GT(sky, 0.6);
    EXPECT_LT(sky, 0.95);
    EXPECT_GT(ground, 0.2);
    EXPECT_LT(ground, 0.5);
  }
}

TEST(AutomaticExposure, IsWrittenDownAndStopsAreAdded) {
  const std::vector<double> values = room(900, 0.02);
  const auto exposure = [&](const char* text) { return tone_map(text)->apply(grey(values, 30)).metadata; };
  const std::string found = exposure("AgXToneMap {}").at("exposure");
  EXPECT_NEAR(std::stod(exposure("AgXToneMap { stops: 1.5 }").at("exposure")), std::stod(found) + 1.5, 0.011);
  EXPECT_FALSE(exposure("AgXToneMap { exposure: fixed }").contains("exposure"));
  // The exposure that was found, given as a fixed number, gives the same picture.
  const Image a = tone_map("AgXToneMap {}")->apply(grey(values, 30));
  const Image b =
      tone_map("AgXToneMap { exposure: fixed, stops: " + found.substr(0, found.find(' ')) + " }")->apply(grey(values, 30));
  for (size_t i = 0; i < a.values.size(); ++i) EXPECT_NEAR(a.values[i], b.values[i], 0.002);
}

// ---- what a job does by default -------------------------------------------------------------------------------------------

TEST(DefaultDisplay, PicturesAreExposedAndRadianceIsKept) {
  const TemporaryFolder folder;
  const Ref<Job> job = load_job_text(R"(
Job {
    renderer: PathTracer { samples: 4 }
    camera: PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] m }
    image: ImageBuffer { width: 24, height: 24 }
    scene: BruteForceScene { objects: [
        Sphere { shader: Lambertian { color: 0.5 } }
        Sphere { centre: [0, 5, -3] m, emission: DiffuseEmission { radiance: 2e-5 } }
    ] }
    outputs: [ PngOutput {}, TgaOutput {}, ExrOutput {}, NpyOutput {}, HdrOutput {} ]
})",
                                     "a job");
  const auto render = test::rendered(job);
  const Image radiance = render->picture();
  render->write_outputs(folder / "out");
  double brightest = 0;
  for (const double v : radiance.values) brightest = std::max(brightest, v);
  ASSERT_LT(brightest, 1e-4);
  EXPECT_LT(compare(read_image(folder / "out.npy"), radiance).maximum_difference, 1e-12);
  EXPECT_LT(compare(read_image(folder / "out.exr"), radiance).maximum_difference, 1e-3 * brightest);
  EXPECT_LT(compare(read_image(folder / "out.hdr"), radiance).maximum_difference, 2e-2 * brightest);
  const Image expected = tone_map("AgXToneMap {}")->apply(radiance);
  for (const char* file : {"out.png", "out.tga"}) {
    const Image image = read_image(folder / file);
    double most = 0;
    for (size_t i = 0; i < expected.values.size(); ++i) {
      most = std::max(most, expected.values[i]);
      EXPECT_NEAR(encode_transfer("srgb", image.values[i]), expected.values[i], 0.51 / 255) << file;
    }
    EXPECT_GT(most, 0.5);
  }
}

}  // namespace
}  // namespace etendue
