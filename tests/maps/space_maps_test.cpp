// Maps through space (solid textures): GridMap, BlackbodyMap, CloudMap.

#include <fmt/format.h>

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "support/luminaire_test_support.h"

namespace etendue::test {
namespace {

SurfacePoint place(const Point3& p) {
  SurfacePoint s;
  s.position = s.object_position = p;
  s.normal = s.shading_normal = s.object_normal = {0, 0, 1};
  return s;
}

// Values that are a linear function of the cells' middles are interpolated linearly; with three values per cell, so is each
// channel.
TEST(GridMap, IsLinearBetweenTheMiddlesOfCells) {
  const auto wanted = [](const Point3& p) { return 1 + 2 * p.x + 3 * p.y - 5 * p.z; };
  std::string one, three;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 4; ++x) {
        const float v = wanted({(float(x) + 0.5f) / 4, (float(y) + 0.5f) / 3, (float(z) + 0.5f) / 2});
        one += fmt::format("{}, ", v);
        three += fmt::format("{}, {}, {}, ", 5 + v, 10 + v, 0.25);
      }
  const auto map = [](const std::string& values, const char* more = "") {
    return prepared_as<ObjectMap>("GridMap { resolution: [4, 3, 2], values: [" + values.substr(0, values.size() - 2) + "]" +
                                  more + " }");
  };
  const Point3 p{0.4f, 0.3f, 0.6f};
  EXPECT_NEAR(map(one)->scalar(place(p)), wanted(p), 1e-5f);
  EXPECT_NEAR(map(one, ", placement: translate([1, 2, 3]) * scale(2)")->scalar(place({1.8f, 2.6f, 4.2f})), wanted(p), 1e-5f);
  // As a colour, negative values become 0.
  EXPECT_LT(map(one)->scalar(place({0.2f, 0.2f, 0.7f})), 0);
  EXPECT_EQ(map(one)->color(place({0.2f, 0.2f, 0.7f}), wavelengths(), ColorUse::coefficient)[0], 0);
  const Ref<ObjectMap> colored = map(three);
  const Wavelengths w = wavelengths();
  const Color c = rgb_color("srgb", 5 + wanted(p), 10 + wanted(p), 0.25);
  const Spectrum s = colored->color(place(p), w, ColorUse::coefficient);
  for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(s[k], c->at(w[k], ColorUse::coefficient), 0.02f);
  EXPECT_EQ(map(one, ", outside: empty")->scalar(place({2, 0.5f, 0.5f})), 0);
  expect_refused("GridMap { resolution: [2, 1, 1], values: [1, 2, 3] }", "values", "for a grid of 2");
  expect_refused("GridMap { resolution: [2, 1], values: [1, 2] }", "resolution", "three numbers");
}

// Over a footprint a map is the mean: 1/2 for a checkerboard of cells, seen from above by cones as wide as four cells.
TEST(GridMap, IsTheMeanOverAFootprint) {
  std::string values;
  for (int i = 0; i < 64; ++i) values += fmt::format("{}{}", i ? ", " : "", (i % 8 + i / 8) % 2);
  const Ref<ObjectMap> map =
      prepared_as<ObjectMap>("GridMap { resolution: [8, 8, 1], values: [" + values + "], filter: nearest }");
  SurfacePoint p = place({0.5f, 0.5f, 0.5f});
  p.dpdu = {1, 0, 0};
  p.dpdv = {0, 1, 0};
  p.ray_direction = {0, 0, -1};
  p.footprint = 0.5f;
  EXPECT_NEAR(map->scalar(p), 0.5f, 1e-5f);
}

// The ratio follows Planck's law, and the position of the maximum Wien's; the colour `blackbody` is an independent
// implementation.
TEST(BlackbodyMap, IsPlancksRadiance) {
  const Wavelengths w = wavelengths();
  for (const double kelvin : {900.0, 2856.0, 6500.0}) {
    const Ref<ObjectMap> map = prepared_as<ObjectMap>(fmt::format("BlackbodyMap {{ temperature: {}, factor: 3 }}", kelvin));
    const Spectrum s = map->color(place({}), w, ColorUse::radiance);
    const Color expected = blackbody_spectrum(kelvin);
    for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(s[k] / (3 * expected->at(w[k], ColorUse::radiance)), 1, 1e-4);
  }
  // At 5000 K the maximum is at 579.55 nm.
  const Ref<ObjectMap> one = prepared_as<ObjectMap>("BlackbodyMap { temperature: 5000, normalized: true }");
  const Color black = blackbody_spectrum(5000);
  const Spectrum s = one->color(place({}), w, ColorUse::radiance);
  for (int k = 0; k < spectrum_size; ++k)
    EXPECT_NEAR(s[k], black->at(w[k], ColorUse::radiance) / black->at(579.55f, ColorUse::radiance), 1e-4);
  EXPECT_EQ(prepared_as<ObjectMap>("BlackbodyMap { temperature: 0 }")->scalar(place({})), 0);
  EXPECT_TRUE(std::isfinite(prepared_as<ObjectMap>("BlackbodyMap { temperature: 1e30 }")->scalar(place({}))));
}

// Solid up to the base, empty above the top, and torn between them: partly empty and partly full.
TEST(CloudMap, IsSolidAtItsFootAndTornAbove) {
  const Ref<ObjectMap> map = prepared_as<ObjectMap>("CloudMap { size: 2, base: [1, 1, 1], up: [0, 3, 0], amount: 3 }");
  int empty = 0, between = 0;
  double sum = 0;
  for (int i = 0; i < 4000; ++i) {
    const float x = float(i % 63) * 0.17f, z = float(i % 67) * 0.13f;
    EXPECT_EQ(map->scalar(place({x, 0.99f, z})), 1);
    EXPECT_EQ(map->scalar(place({x, 3.01f, z})), 0);
    const float v = map->scalar(place({x, 2.2f, z}));
    ASSERT_TRUE(v >= 0 && v <= 1);
    if (v == 0) ++empty;
    if (v > 0) ++between;
    sum += double(v);
  }
  // The noise is negative as often as positive.
  EXPECT_NEAR(empty, 2000, 400);
  EXPECT_NEAR(between, 2000, 400);
  EXPECT_GT(sum / between, 0.2);
  // Without billows all noise is that of a lattice point, 0: the solid part remains.
  EXPECT_FLOAT_EQ(prepared_as<ObjectMap>("CloudMap { wispiness: 0, frequency: 0 }")->scalar(place({0.3f, 0.1f, 0.3f})), 0.4f);
  expect_refused("CloudMap { up: [0, 0, 0] }", "up", "direction");
}

}  // namespace
}  // namespace etendue::test
