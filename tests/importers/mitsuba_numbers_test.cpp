// Unexpected meanings of numbers in Mitsuba 2 and 3, found by comparing random scenes (tests/references/differential.py).

#include "mitsuba_support.h"

namespace etendue::mitsuba_test {
namespace {

/// The light of two surfaces of reflectance 0.8 and 0.2, mixed by a checkerboard of 0 and 1, at the point with u = v = 0.25.
double mixed_by_checkers(const std::string& version) {
  const std::string view =
      "<float name=\"fov\" value=\"0.1\"/><transform name=\"to_world\"><lookat origin=\"-0.5 -0.5 4\" target=\"-0.5 -0.5 0\" "
      "up=\"0 1 0\"/></transform>";
  const std::string shape =
      "<shape type=\"rectangle\"><bsdf type=\"blendbsdf\"><texture type=\"checkerboard\" name=\"weight\"><float "
      "name=\"color0\" value=\"0\"/><float name=\"color1\" value=\"1\"/></texture>"
      "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"0.8\"/></bsdf>"
      "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"0.2\"/></bsdf></bsdf></shape>";
  return seen(import_text(scene(sensor(view) + integrator() + "<emitter type=\"constant\"/>" + shape, version)), 4096).y;
}

// For colours, "color0" is where u and v are both below or both above a half (MitsubaTexture.CheckersAndTheirPlace); for
// numbers the two are exchanged.
TEST(MitsubaTexture, CheckersAsNumbersAreExchanged) {
  EXPECT_NEAR(mixed_by_checkers("3.0.0"), 0.2, 0.01);
  EXPECT_NEAR(mixed_by_checkers("0.6.0"), 0.8, 0.01);
}

Transform turned(const std::string& rotate, const std::string& version) {
  const Imported imported = import_text(
      seen_scene("<shape type=\"rectangle\"><transform name=\"to_world\">" + rotate + "</transform></shape>", 2, version));
  EXPECT_TRUE(imported.errors.empty()) << imported.told();
  if (!imported.job) return {};
  const Value value = get(imported.object(0), "transform");
  if (const auto* moved = value.as<AnimatedTransform>()) return moved->still();
  return value.as<Transform>() ? *value.as<Transform>() : Transform();
}

// The numbers are those that Mitsuba 3.9.1 prints of ScalarTransform4f().rotate([0.446, 0, 0], 20.198).
TEST(MitsubaTransform, AnAxisIsTakenAtItsLength) {
  const Transform::DoubleMatrix there = turned("<rotate x=\"0.446\" angle=\"20.198\"/>", "3.0.0").exact();
  const double wanted[12] = {0.950737, 0, 0, 0, 0, 0.938505, -0.153988, 0, 0, 0.153988, 0.938505, 0};
  for (size_t i = 0; i < 12; ++i) EXPECT_NEAR(there[i], wanted[i], 1e-5) << i;
  const Transform::DoubleMatrix before = turned("<rotate x=\"0.446\" angle=\"20.198\"/>", "0.6.0").exact();
  EXPECT_NEAR(before[0], 1, 1e-9);
  EXPECT_NEAR(before[6], -0.345265, 1e-5);
  // With an axis of length 1 both versions rotate: x to y about z.
  const Transform::DoubleMatrix quarter = turned("<rotate z=\"1\" angle=\"90\"/>", "3.0.0").exact();
  EXPECT_NEAR(quarter[4], 1, 1e-9);
  EXPECT_NEAR(quarter[1], -1, 1e-9);
}

// An axis with three components, not normalized: c + (1 - c) a_i a_j plus or minus s times the remaining component, with c = 0
// and s = 1.
TEST(MitsubaTransform, AnAxisOfAnyDirectionIsTakenAtItsLength) {
  const Transform::DoubleMatrix m = turned("<rotate x=\"1\" y=\"2\" z=\"3\" angle=\"90\"/>", "3.0.0").exact();
  const double wanted[12] = {1, -1, 5, 0, 5, 4, 5, 0, 1, 7, 9, 0};
  for (size_t i = 0; i < 12; ++i) EXPECT_NEAR(m[i], wanted[i], 1e-9) << i;
}

}  // namespace
}  // namespace etendue::mitsuba_test
