// Lights of USD: the words and formulas of UsdLux, against rendered values.

#include "usd_support.h"

namespace etendue {
namespace {

using test::expect_rgb;
using test::rgb;
using test::y_up;
using UsdLights = test::UsdTest;

TEST_F(UsdLights, ARectangleShinesOnOneSideWithItsLuminance) {
  const std::string text = y_up + light("RectLight", "float inputs:intensity = 3\nfloat inputs:exposure = 1\n", 0);
  const Ref<Scene> s = scene(text);
  ASSERT_TRUE(s) << error_;
  EXPECT_NEAR(mean(picture(s, "OrthographicCamera { from: [0, 0, -3], to: [0, 0, 0], width: 0.9 }", 4, 16)), 6, 0.06);
  EXPECT_EQ(mean(picture(s, "OrthographicCamera { from: [0, 0, 3], to: [0, 0, 0], width: 0.9 }", 4, 16)), 0);
}

TEST_F(UsdLights, NormalizedLightsAreDividedByTheirSizeInTheStagesUnits) {
  const auto normalized = [](const std::string& type, const std::string& members, const std::string& scale) {
    return "def " + type + " \"l\" {\nbool inputs:normalize = 1\nfloat inputs:intensity = 60000\n" + members +
           "\nfloat3 xformOp:scale = " + scale + "\nuniform token[] xformOpOrder = [\"xformOp:scale\"]\n}\n";
  };
  const std::string round = "float inputs:radius = 50";
  const auto seen =
      of_each("#usda 1.0\n( upAxis = \"Y\"\n metersPerUnit = 0.01 )\n",
              {normalized("RectLight", "float inputs:width = 100\nfloat inputs:height = 50", "(2, 3, 4)"),
               normalized("DiskLight", round, "(2, 3, 4)"), normalized("SphereLight", round, "(1, 1, 1)"),
               normalized("SphereLight", round, "(2, 2, 1)"),
               normalized("CylinderLight", round + "\nfloat inputs:length = 100", "(1, 1, 1)")},
              [&](const Ref<Scene>& s) {
                return mean(picture(s, "OrthographicCamera { from: [0, 0, -3], to: [0, 0, 0], width: 0.1 }", 4, 16));
              });
  // An ellipsoid with half axes of 100, 100 and 50: 2 pi a^2 (1 + (1 - e^2) / e atanh e), e^2 = 1 - c^2 / a^2.
  const double e = std::sqrt(0.75), ellipsoid = 2 * double(pi) * 100 * 100 * (1 + 0.25 / e * std::atanh(e));
  const double areas[] = {100 * 50 * 2 * 3, double(pi) * 50 * 50 * 2 * 3, 4 * double(pi) * 50 * 50, ellipsoid,
                          2 * double(pi) * 50 * 100};
  for (size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(seen[i] * areas[i] / 60000, 1, 0.01) << i;
}

TEST_F(UsdLights, WhatLightsSendToAPatchBelow) {
  struct Row {
    std::string light;
    double wanted, within;
  };
  const std::string shaped = "(prepend apiSchemas = [\"ShapingAPI\"])",
                    aside =
                        "double3 xformOp:translate = (2, 0, 2)\nuniform token[] "
                        "xformOpOrder = [\"xformOp:translate\"]\n}\n",
                    ball = "float inputs:radius = 0.1\nfloat inputs:intensity = 100\n",
                    cone = "float inputs:shaping:cone:angle = 20\n";
  const Row rows[] = {
      // A disc and a sphere over a patch: L sin^2 of the half angle that they subtend.
      {light("DiskLight", "float inputs:radius = 1\nfloat inputs:intensity = 5", 2), 5.0 / 5, 0.01},
      {light("SphereLight", "float inputs:radius = 1\nfloat inputs:intensity = 5", 2), 5.0 / 4, 0.0125},
      // Treated as a point it has the intensity pi r^2 L, and the patch receives that over the square of the distance.
      {light("SphereLight", "float inputs:radius = 1\nfloat inputs:intensity = 5\nbool treatAsPoint = 1", 2), 5.0 / 4, 0.01},
      // The sun of UsdLux' defaults: 50000 cd/m^2 from a disc of 0.53 degrees.
      {"def DistantLight \"l\" {\n}\n", 50000 * std::pow(std::sin(0.265 * double(pi) / 180), 2), 0.02},
      // Normalized, the intensity is what the patch receives [lx], whatever the angle.
      {"def DistantLight \"l\" {\nbool inputs:normalize = 1\nfloat inputs:intensity = 7\nfloat inputs:angle = 20\n}\n",
       7 / double(pi), 0.03},
      {"def DistantLight \"l\" {\nfloat inputs:intensity = 7\nfloat inputs:angle = 0\n}\n", 7 / double(pi), 0.02},
      {"def DomeLight \"l\" {\nfloat inputs:intensity = 0.25\n}\n", 0.25, 0.003},
      // As files were written before 2021, without "inputs:".
      {light("DiskLight", "float radius = 1\nfloat intensity = 5", 2), 5.0 / 5, 0.01},
      // A cone about -z: the patch lies in the axis, then 45 degrees off it.
      {light("SphereLight", ball, 2, shaped), 0.25, 0.005},
      {light("SphereLight", ball + cone, 2, shaped), 0.25, 0.005},
      {"def SphereLight \"l\" " + shaped + " {\n" + ball + cone + aside, 0, 0},
      // Soft from 20 degrees on, 45 of 80 degrees off: t = 35 / 60 of a smooth step in the angle.
      {"def SphereLight \"l\" " + shaped + " {\n" + ball +
           "float inputs:shaping:cone:angle = 80\nfloat inputs:shaping:cone:softness = 0.75\n" + aside,
       100 * 0.01 / 8 * std::sqrt(0.5) * 35 * 35 / 3600.0 * (3 - 70 / 60.0), 0.001},
      // A focus is cos^n: of the middle of a small disc, 45 degrees off, cos^3 of that.
      {"def DiskLight \"l\" " + shaped +
           " {\nfloat inputs:radius = 0.02\nfloat inputs:intensity = 10000\nfloat inputs:shaping:focus = 3\n" + aside,
       10000 * 0.02 * 0.02 / 8 * 0.5 * std::pow(0.5, 1.5), 0.002},
  };
  std::vector<std::string> lights;
  for (const Row& row : rows) lights.push_back(row.light);
  const std::vector<double> seen = lit(lights);
  for (size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(seen[i], rows[i].wanted, rows[i].within) << rows[i].light;
}

TEST_F(UsdLights, IesFilesMultiplyTheLuminanceByTheirCandelas) {
  folder_.write("lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n300 200 0\n");
  // Linear in the angle up to 45 degrees, and again from there on; the lumens by the midpoint rule.
  double lumens = 0;
  constexpr int n = 10000;
  for (int i = 0; i < n; ++i) {
    const double t = double(pi) / 2 * (i + 0.5) / n, degrees = 90 * (i + 0.5) / n;
    lumens += 2 * double(pi) * (degrees < 45 ? 300 - 100 * degrees / 45 : 400 - 200 * degrees / 45) * std::sin(t) * double(pi) /
              2 / n;
  }
  const std::string file = "(prepend apiSchemas = [\"ShapingAPI\"]) {\nasset inputs:shaping:ies:file = @lamp.ies@\n",
                    aside =
                        "double3 xformOp:translate = (2, 0, 2)\nuniform token[] xformOpOrder = [\"xformOp:translate\"]\n}\n",
                    above =
                        "double3 xformOp:translate = (0, 0, 2)\nuniform token[] xformOpOrder = [\"xformOp:translate\"]\n}\n",
                    small = "float inputs:radius = 0.02\nfloat inputs:intensity = 10\n",
                    even = "bool inputs:shaping:ies:normalize = 1\n";
  const double r2 = 0.02 * 0.02;
  const std::pair<std::string, double> rows[] = {
      {"def DiskLight \"l\" " + file + small + above, 10 * 300 * r2 / 4},
      {"def DiskLight \"l\" " + file + small + aside, 10 * 200 * r2 / 8 * 0.5},
      {"def SphereLight \"l\" " + file + small + aside, 10 * 200 * r2 / 8 * std::sqrt(0.5)},
      {"def SphereLight \"l\" " + file + small + "bool treatAsPoint = 1\n" + aside, 10 * 200 * r2 / 8 * std::sqrt(0.5)},
      {"def SphereLight \"l\" " + file + small + even + aside, 10 * 200 / lumens * r2 / 8 * std::sqrt(0.5)},
      {"def CylinderLight \"l\" " + file + "float inputs:length = 0.02\n" + small + above,
       10 * 300 * 2 * 0.02 * 0.02 / double(pi) / 4}};
  std::vector<std::string> lights;
  for (const auto& row : rows) lights.push_back(row.first);
  const std::vector<double> seen = lit(lights);
  for (size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(seen[i], rows[i].second, 0.02 * rows[i].second) << rows[i].first;
}

TEST_F(UsdLights, PicturesOnLightsStandUpright) {
  folder_.write("corners.ppm", "P3\n2 2\n255\n255 0 0  0 255 0\n0 0 255  255 255 255\n");
  const Ref<Scene> s = scene(y_up + light("RectLight",
                                          "asset inputs:texture:file = @corners.ppm@\nfloat inputs:intensity = 2\n"
                                          "color3f inputs:color = (1, 0.5, 1)",
                                          0));
  ASSERT_TRUE(s) << error_;
  const Image image = picture(s, "OrthographicCamera { from: [0, 0, -3], to: [0, 0, 0], width: 0.999 }", 8, 256);
  expect_rgb(image, 0, 0, {2, 0, 0}, 0.1);
  expect_rgb(image, 7, 0, {0, 1, 0}, 0.1);
  expect_rgb(image, 0, 7, {0, 0, 2}, 0.1);
  expect_rgb(image, 7, 7, {2, 1, 2}, 0.1);
}

TEST_F(UsdLights, DomesLieAsInOpenExr) {
  // Six columns of longitude from +180 to -180 degrees: +z (longitude 0) lies between the third and the fourth, +x (90 degrees)
  // in the second, -x in the fifth; two rows: above green counts, below not.
  folder_.write("sky.ppm",
                "P3\n6 2\n255\n0 255 0  255 255 0  0 255 0  0 255 0  0 255 255  0 255 0\n"
                "0 0 0  255 0 0  0 0 0  0 0 0  0 0 255  0 0 0\n");
  const auto seen = [&](const std::string& up, const std::string& type, const char* to) {
    const Ref<Scene> s = scene("#usda 1.0\n( upAxis = \"" + up + "\"\n metersPerUnit = 1 )\ndef " + type +
                               " \"d\" { asset inputs:texture:file = @sky.ppm@\n}");
    EXPECT_TRUE(s) << error_;
    return picture(s, std::string("PerspectiveCamera { from: [0, 0, 0], to: ") + to + ", fov: 1 }", 1, 64);
  };
  expect_rgb(seen("Y", "DomeLight", "[1, -1, 0]"), 0, 0, {1, 0, 0}, 0.05);
  expect_rgb(seen("Y", "DomeLight", "[-1, -1, 0]"), 0, 0, {0, 0, 1}, 0.05);
  expect_rgb(seen("Y", "DomeLight", "[0, 1, 1]"), 0, 0, {0, 1, 0}, 0.05);
  // In a stage with z upwards (its y is then our -z) a DomeLight_1 stands with its pole along z, and a DomeLight along y.
  expect_rgb(seen("Z", "DomeLight_1", "[1, 1, 0]"), 0, 0, {1, 1, 0}, 0.05);
  expect_rgb(seen("Z", "DomeLight", "[1, 0, -1]"), 0, 0, {1, 1, 0}, 0.05);
}

}  // namespace
}  // namespace etendue
