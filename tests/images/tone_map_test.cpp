// Tone maps.

#include <gtest/gtest.h>

#include "etendue/describe/color.h"
#include "etendue/tone_map.h"

namespace etendue {
namespace {

Ref<ToneMap> make_map(const std::string& name, std::initializer_list<std::pair<const char*, double>> members = {},
                      const std::string& transfer = "linear") {
  const Ref<Component> c = Registry::instance().create(name);
  for (const auto& [member, value] : members) set(*c, member, Value(Number{value}));
  set(*c, "transfer", Value(transfer));
  const auto map = ref_cast<ToneMap>(c);
  map->prepare();
  return map;
}

/// Pixels in one row from colours in linear sRGB.
Image row(const std::vector<std::array<double, 3>>& colors) {
  Image image(int(colors.size()), 1, {"X", "Y", "Z"});
  image.metadata["color_space"] = "xyz";
  const std::array<double, 9> m = rgb_space("srgb").to_xyz;
  for (size_t i = 0; i < colors.size(); ++i)
    for (size_t c = 0; c < 3; ++c)
      image.values[3 * i + c] = m[3 * c] * colors[i][0] + m[3 * c + 1] * colors[i][1] + m[3 * c + 2] * colors[i][2];
  return image;
}

Image greys(const std::vector<double>& values) {
  std::vector<std::array<double, 3>> colors;
  for (const double v : values) colors.push_back({v, v, v});
  return row(colors);
}

std::vector<const ClassInfo*> all_maps() { return Registry::instance().subclasses(*Registry::instance().find("ToneMap")); }

TEST(ToneMap, MonotoneBlackToBlackAndBounded) {
  std::vector<double> ramp = {0};
  for (double v = 1e-4; v < 50; v *= 1.5) ramp.push_back(v);
  ASSERT_GE(all_maps().size(), 6u);
  for (const ClassInfo* c : all_maps())
    for (const char* transfer : {"linear", "srgb"}) {
      const auto map = make_map(c->name, {}, transfer);
      const Image out = map->apply(greys(ramp));
      ASSERT_EQ(out.channels, (std::vector<std::string>{"R", "G", "B"}));
      EXPECT_EQ(out.metadata.at("transfer"), transfer);
      EXPECT_EQ(out.metadata.at("color_space"), "srgb");
      EXPECT_NEAR(out.at(0, 0, 0), 0, 1e-12) << c->name;
      for (int x = 1; x < out.width; ++x)
        for (size_t k = 0; k < 3; ++k) {
          EXPECT_GE(out.at(x, 0, k), out.at(x - 1, 0, k) - 1e-12) << c->name;
          EXPECT_NEAR(out.at(x, 0, k), out.at(x, 0, 0), 1e-6) << c->name;
          EXPECT_TRUE(out.at(x, 0, k) <= 1 || !map->clips()) << c->name;
        }
    }
}

TEST(ToneMap, BrightestBecomesWhite) {
  for (const char* name : {"NormalizeToneMap", "SquareRootToneMap", "CubeRootToneMap", "SchlickToneMap"}) {
    const Image out = make_map(name, {}, "srgb")->apply(greys({0.1, 2, 37}));
    EXPECT_NEAR(out.at(2, 0, 1), 1, 1e-6) << name;
    EXPECT_LT(out.at(1, 0, 1), 0.95) << name;
  }
}

TEST(ToneMap, Formulas) {
  const Image in = greys({0.01, 1, 4, 10});
  const auto check = [&](const Ref<ToneMap>& map, const std::vector<double>& expected) {
    const Image out = map->apply(in);
    for (size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(out.at(int(i), 0, 1), expected[i], 1e-6) << map->class_info().name << ' ' << i;
  };
  check(make_map("NoToneMap"), {0.01, 1, 4, 10});
  check(make_map("ExposureToneMap"), {0.01, 1, 1, 1});
  check(make_map("ExposureToneMap", {{"stops", -3}}), {0.00125, 0.125, 0.5, 1});
  check(make_map("NormalizeToneMap"), {0.001, 0.1, 0.4, 1});
  check(make_map("NormalizeToneMap", {{"percentile", 75}}), {0.0025, 0.25, 1, 1});
  check(make_map("SquareRootToneMap"), {std::sqrt(0.001), std::sqrt(0.1), std::sqrt(0.4), 1});
  check(make_map("CubeRootToneMap"), {0.1, std::cbrt(0.1), std::cbrt(0.4), 1});
  // F(x) = p x / ((p - 1) x + 1) at x = 0.001, 0.1, 0.4
  check(make_map("SchlickToneMap", {{"p", 10}}), {0.01 / 1.009, 1 / 1.9, 4 / 4.6, 1});
  check(make_map("SchlickToneMap", {{"p", 1}}), {0.001, 0.1, 0.4, 1});
  // p is found so that the darkest value becomes the level M of N.
  check(make_map("SchlickToneMap"), {1.0 / 256});
  check(make_map("SchlickToneMap", {{"darkest_grey", 3}, {"levels", 64}}), {3.0 / 64});
}

TEST(ToneMap, KeepsChromaticity) {
  const Image in = row({{0.1, 0.05, 0.025}, {0.02, 0.04, 0.01}, {1, 1, 1}});
  for (const char* name : {"NormalizeToneMap", "SquareRootToneMap", "CubeRootToneMap", "SchlickToneMap", "ExposureToneMap"}) {
    const Image out = make_map(name)->apply(in);
    EXPECT_NEAR(out.at(0, 0, 1) / out.at(0, 0, 0), 0.5, 1e-6) << name;
    EXPECT_NEAR(out.at(1, 0, 0) / out.at(1, 0, 1), 0.5, 1e-6) << name;
    EXPECT_NEAR(out.at(1, 0, 2) / out.at(1, 0, 1), 0.25, 1e-6) << name;
  }
}

TEST(ToneMap, EncodesAndClips) {
  // sRGB: 0.5 encodes as 1.055 * 0.5^(1/2.4) - 0.055
  EXPECT_NEAR(make_map("ExposureToneMap", {}, "srgb")->apply(greys({0.5})).at(0, 0, 0), 0.735357, 1e-5);
  EXPECT_NEAR(make_map("ExposureToneMap", {}, "gamma2.2")->apply(greys({0.5})).at(0, 0, 0), std::pow(0.5, 1 / 2.2), 1e-6);
  // A colour outside the space: clipped by all maps except the one that changes nothing.
  Image outside(1, 1, {"X", "Y", "Z"});
  outside.values = {0, 0.5, 0};
  EXPECT_EQ(make_map("ExposureToneMap")->apply(outside).at(0, 0, 0), 0);
  EXPECT_LT(make_map("NoToneMap")->apply(outside).at(0, 0, 0), -0.5);
  Image bad = greys({1, 2});
  bad.values[1] = std::numeric_limits<double>::quiet_NaN();
  for (const ClassInfo* c : all_maps())
    if (const auto map = make_map(c->name); map->clips()) {
      const Image out = map->apply(bad);
      for (const double v : out.values) EXPECT_TRUE(v >= 0 && v <= 1) << c->name;
      EXPECT_EQ(map->apply(greys({0, 0})).values, std::vector<double>(6)) << c->name;
    }
}

TEST(ToneMap, RefusesWhatIsUnknown) {
  const auto map = make_map("NoToneMap");
  for (const char* member : {"transfer", "color_space"}) EXPECT_THROW(set(*map, member, Value(std::string("srbg"))), Error);
  EXPECT_THROW(make_map("SchlickToneMap", {{"p", 0.5}}), Error);
  EXPECT_THROW(make_map("SchlickToneMap", {{"darkest_grey", 256}}), Error);
  EXPECT_THROW(make_map("NormalizeToneMap", {{"percentile", 0}}), Error);
  EXPECT_THROW(make_map("NoToneMap")->apply(Image(1, 1, {"R", "G", "B"})), Error);
}

}  // namespace
}  // namespace etendue
