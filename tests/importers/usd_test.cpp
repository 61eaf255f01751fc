// USD scenes: what UsdLux and UsdPreviewSurface say in words and formulas, against what is seen. Needs usd-core; without it
// only its message is tested (foreign_models_test.cpp).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "components/objects/meshes/mesh_data.h"
#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "etendue/scene.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue {
namespace {

const std::string y_up = "#usda 1.0\n( upAxis = \"Y\"\n metersPerUnit = 1 )\n";

class UsdTest : public testing::Test {
 protected:
  void SetUp() override {
    const char* python = std::getenv("ETENDUE_PYTHON");
    const std::string check = std::string(python && *python ? python : "python3") + " -c 'import pxr, numpy' 2>/dev/null";
    if (std::system(check.c_str()) != 0) GTEST_SKIP() << "usd-core is not installed";
  }

  /// The scene of a file, or none and its error.
  Ref<Scene> scene(const std::string& text, ImportOptions options = {}) {
    return scene_of(folder_.write("scene" + std::to_string(++number_) + ".usda", text), std::move(options));
  }
  Ref<Scene> scene_of(const std::string& path, ImportOptions options = {}) {
    notes_.clear();
    error_.clear();
    try {
      Importing importing(path, std::move(options));
      const Ref<Component> read = importer_of(path)->import(importing);
      for (const Error& note : importing.notes()) notes_.emplace_back(note.what());
      job_ = ref_cast<Job>(read);
      return job_ ? job_->scene : ref_cast<Scene>(read);
    } catch (const Error& error) {
      EXPECT_STREQ(error.location.file, path.c_str()) << error.what();
      error_ = error.what();
      return nullptr;
    }
  }

  bool told(const std::string& words) const {
    return std::ranges::any_of(notes_, [&](const std::string& n) { return n.find(words) != std::string::npos; });
  }

  /// What a camera sees of a scene and further objects.
  Image picture(const Ref<Scene>& scene, const std::string& camera, int size, int samples = 1, const std::string& more = "") {
    const Ref<Job> job = load_job_text(
        test::job_text("PathTracer { samples: " + std::to_string(samples) + ", max_depth: 2 }", camera, size, more), "t.etd");
    for (const Ref<SceneObject>& object : scene->objects) job->scene->objects.push_back(object);
    return test::rendered(job)->picture();
  }
  static double mean(const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) sum += image.at(x, y, 1);
    return sum / (double(image.width) * image.height);
  }
  /// What is seen of each of several objects of one file on its own, which are all called "l".
  std::vector<double> of_each(const std::string& head, const std::vector<std::string>& objects,
                              const std::function<double(const Ref<Scene>&)>& look) {
    std::string text = head;
    for (size_t i = 0; i < objects.size(); ++i) {
      std::string named = objects[i];
      named.replace(named.find("\"l\""), 3, "\"l" + std::to_string(i) + "\"");
      text += named;
    }
    const Ref<Scene> all = scene(text);
    std::vector<double> seen(objects.size(), -1);
    if (!all || all->objects.size() != objects.size()) {
      ADD_FAILURE() << error_ << "\n" << text;
      return seen;
    }
    const std::vector<Ref<SceneObject>> list = all->objects;
    for (size_t i = 0; i < list.size(); ++i) {
      all->objects = {list[i]};
      seen[i] = look(all);
    }
    return seen;
  }
  /// The luminance of a white matte patch at the origin that faces +z under each: what it receives, over pi.
  std::vector<double> lit(const std::vector<std::string>& lights) {
    return of_each(y_up, lights, [&](const Ref<Scene>& s) {
      return mean(
          picture(s, "OrthographicCamera { from: [0, 0, 0.5], to: [0, 0, 0], width: 0.001 }", 8, 64,
                  "Rectangle { corner: [-0.001, -0.001, 0] m, edge_u: [0.002, 0, 0] m, edge_v: [0, 0.002, 0] m, shader: "
                  "Lambertian { color: 1 } }"));
    });
  }
  static std::string light(const std::string& type, const std::string& members, double z, const std::string& more = "") {
    return "def " + type + " \"l\" " + more + " {\n" + members + "\ndouble3 xformOp:translate = (0, 0, " + std::to_string(z) +
           ")\nuniform token[] xformOpOrder = [\"xformOp:translate\"]\n}\n";
  }

  static MeshData mesh_of(const SceneObject& object) {
    const Value file = get(object, "file"), part = get(object, "part");
    return read_mesh(file.as<FilePath>()->resolved(), *part.as<std::string>());
  }

  std::string written(const Ref<Scene>& s) { return s ? write_description(*s) : error_; }

  const TemporaryFolder folder_;
  std::vector<std::string> notes_;
  std::string error_;
  Ref<Job> job_;
  int number_ = 0;
};

constexpr double pi_ = 3.14159265358979323846;

/// Of one pixel, red, green and blue of linear sRGB.
std::array<double, 3> rgb(const Image& image, int x, int y) {
  const double X = image.at(x, y, 0), Y = image.at(x, y, 1), Z = image.at(x, y, 2);
  return {3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z, -0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z,
          0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z};
}
void expect_rgb(const Image& image, int x, int y, std::array<double, 3> wanted, double within) {
  const auto seen = rgb(image, x, y);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], wanted[i], within) << "pixel " << x << ", " << y << " channel " << i;
}

// ---- lights -----------------------------------------------------------------------------------------------------------------

TEST_F(UsdTest, ARectangleShinesOnOneSideWithItsLuminance) {
  const std::string text = y_up + light("RectLight", "float inputs:intensity = 3\nfloat inputs:exposure = 1\n", 0);
  const Ref<Scene> s = scene(text);
  ASSERT_TRUE(s) << error_;
  EXPECT_NEAR(mean(picture(s, "OrthographicCamera { from: [0, 0, -3], to: [0, 0, 0], width: 0.9 }", 4, 16)), 6, 0.06);
  EXPECT_EQ(mean(picture(s, "OrthographicCamera { from: [0, 0, 3], to: [0, 0, 0], width: 0.9 }", 4, 16)), 0);
}

TEST_F(UsdTest, NormalizedLightsAreDividedByTheirSizeInTheStagesUnits) {
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
  const double e = std::sqrt(0.75), ellipsoid = 2 * pi_ * 100 * 100 * (1 + 0.25 / e * std::atanh(e));
  const double areas[] = {100 * 50 * 2 * 3, pi_ * 50 * 50 * 2 * 3, 4 * pi_ * 50 * 50, ellipsoid, 2 * pi_ * 50 * 100};
  for (size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(seen[i] * areas[i] / 60000, 1, 0.01) << i;
}

TEST_F(UsdTest, WhatLightsSendToAPatchBelow) {
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
      // A disc and a sphere over a patch: L sin^2 of the half angle under which they are seen.
      {light("DiskLight", "float inputs:radius = 1\nfloat inputs:intensity = 5", 2), 5.0 / 5, 0.01},
      {light("SphereLight", "float inputs:radius = 1\nfloat inputs:intensity = 5", 2), 5.0 / 4, 0.0125},
      // As a point it has the intensity pi r^2 L, and the patch receives that over the square of the distance.
      {light("SphereLight", "float inputs:radius = 1\nfloat inputs:intensity = 5\nbool treatAsPoint = 1", 2), 5.0 / 4, 0.01},
      // The sun of UsdLux' defaults: 50000 cd/m^2 from a disc of 0.53 degrees.
      {"def DistantLight \"l\" {\n}\n", 50000 * std::pow(std::sin(0.265 * pi_ / 180), 2), 0.02},
      // Normalized, the intensity is what the patch receives [lx], whatever the angle.
      {"def DistantLight \"l\" {\nbool inputs:normalize = 1\nfloat inputs:intensity = 7\nfloat inputs:angle = 20\n}\n", 7 / pi_,
       0.03},
      {"def DistantLight \"l\" {\nfloat inputs:intensity = 7\nfloat inputs:angle = 0\n}\n", 7 / pi_, 0.02},
      {"def DomeLight \"l\" {\nfloat inputs:intensity = 0.25\n}\n", 0.25, 0.003},
      // As files were written before 2021, without "inputs:".
      {light("DiskLight", "float radius = 1\nfloat intensity = 5", 2), 5.0 / 5, 0.01},
      // A cone about -z: the patch lies in the axis, then 45 degrees off it.
      {light("SphereLight", ball, 2, shaped), 0.25, 0.005},
      {light("SphereLight", ball + cone, 2, shaped), 0.25, 0.005},
      {"def SphereLight \"l\" " + shaped + " {\n" + ball + cone + aside, 0, 0},
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

TEST_F(UsdTest, PicturesOnLightsStandUpright) {
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

TEST_F(UsdTest, DomesLieAsInOpenExr) {
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

// ---- materials --------------------------------------------------------------------------------------------------------------

/// A square from (-1, -1) to (1, 1) that faces +z, with its surface coordinates.
std::string square(const std::string& material, const std::string& more = "") {
  return "def Mesh \"m\" (prepend apiSchemas = [\"MaterialBindingAPI\"]) {\nrel material:binding = </" + material +
         ">\nint[] faceVertexCounts = [4]\nint[] faceVertexIndices = [0, 1, 2, 3]\npoint3f[] points = [(-1, -1, 0), (1, -1, "
         "0), "
         "(1, 1, 0), (-1, 1, 0)]\nuniform token subdivisionScheme = \"none\"\ntexCoord2f[] primvars:st = [(0, 0), (1, 0), (1, "
         "1), "
         "(0, 1)] (interpolation = \"vertex\")\n" +
         more + "}\n";
}
std::string material(const std::string& inputs, const std::string& shaders) {
  return "def Material \"A\" {\ntoken outputs:surface.connect = </A/S.outputs:surface>\ndef Shader \"S\" {\nuniform token "
         "info:id = "
         "\"UsdPreviewSurface\"\n" +
         inputs + "token outputs:surface\n}\n" + shaders + "}\n";
}
const std::string reader =
    "def Shader \"R\" { uniform token info:id = \"UsdPrimvarReader_float2\"\nstring inputs:varname = \"st\"\nfloat2 "
    "outputs:result\n}\n";

TEST_F(UsdTest, TexturesAreScaledBiasedMovedAndMultipliedInRgb) {
  folder_.write("corners.ppm", "P3\n2 2\n255\n255 0 0  0 255 0\n0 0 255  255 255 255\n");
  const std::string texture =
      "def Shader \"T\" { uniform token info:id = \"UsdUVTexture\"\nasset inputs:file = @corners.ppm@\nfloat4 inputs:scale = "
      "(2, "
      "0.5, 0.25, 1)\nfloat4 inputs:bias = (0.5, 0, 0, 0)\ntoken inputs:wrapS = \"repeat\"\ntoken inputs:wrapT = \"repeat\"\n"
      "float2 inputs:st.connect = </A/X.outputs:result>\nfloat3 outputs:rgb\n}\ndef Shader \"X\" { uniform token info:id = "
      "\"UsdTransform2d\"\nfloat2 inputs:translation = (0.5, 0)\nfloat2 inputs:in.connect = </A/R.outputs:result>\nfloat2 "
      "outputs:result\n}\n";
  const Ref<Scene> s =
      scene(y_up +
            material("color3f inputs:emissiveColor.connect = </A/T.outputs:rgb>\ncolor3f inputs:diffuseColor = (0, 0, 0)\n",
                     texture + reader) +
            square("A"));
  ASSERT_TRUE(s) << error_;
  const Image image = picture(s, "OrthographicCamera { from: [0, 0, 3], to: [0, 0, 0], width: 2 }", 8, 256);
  // A quarter of the side is a texel's middle. It is shifted by half, so that left and right are exchanged. Over the four
  // pixels around it the neighbours have an eighth along each axis.
  const std::array<double, 3> green{0.5, 0.5, 0}, red{2.5, 0, 0}, white{2.5, 0.5, 0.25}, blue{0.5, 0, 0.25};
  const auto middle = [&](int x, int y, const auto& own, const auto& beside, const auto& above, const auto& across) {
    for (size_t k = 0; k < 3; ++k) {
      double sum = 0;
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) sum += rgb(image, x + i, y + j)[k] / 4;
      EXPECT_NEAR(sum, (49 * own[k] + 7 * beside[k] + 7 * above[k] + across[k]) / 64, 0.03)
          << x << ", " << y << " channel " << k;
    }
  };
  middle(1, 1, green, red, white, blue);
  middle(5, 1, red, green, blue, white);
  middle(1, 5, white, blue, green, red);
  middle(5, 5, blue, white, red, green);
}

TEST_F(UsdTest, EachTextureIsReadFromItsOwnImageAndChannel) {
  for (const char* name : {"rough.ppm", "metal.ppm", "hole.ppm", "normal.ppm"}) folder_.write(name, "P3\n1 1\n255\n10 20 30\n");
  const auto texture = [](const std::string& name, const std::string& more) {
    return "def Shader \"" + name + "\" { uniform token info:id = \"UsdUVTexture\"\nasset inputs:file = @" + name +
           ".ppm@\nfloat2 inputs:st.connect = </A/R.outputs:result>\n" + more +
           "float outputs:r\nfloat outputs:g\nfloat3 outputs:rgb\n}\n";
  };
  const Ref<Scene> s = scene(
      y_up +
      material("float inputs:roughness.connect = </A/rough.outputs:g>\nfloat inputs:metallic.connect = </A/metal.outputs:r>\n"
               "float inputs:opacity.connect = </A/hole.outputs:r>\nfloat inputs:opacityThreshold = 0.25\n"
               "normal3f inputs:normal.connect = </A/normal.outputs:rgb>\n",
               texture("rough",
                       "token inputs:sourceColorSpace = \"raw\"\nfloat4 inputs:scale = (1, 0.5, 1, 1)\nfloat4 inputs:bias = "
                       "(0, 0.25, 0, 0)\n") +
                   texture("metal", "token inputs:sourceColorSpace = \"sRGB\"\n") +
                   texture("hole", "token inputs:wrapS = \"clamp\"\n") +
                   texture("normal", "float4 inputs:scale = (2, -2, 2, 1)\nfloat4 inputs:bias = (-1, 1, -1, 0)\n") + reader) +
      square("A"));
  const std::string text = written(s);
  for (const char* there :
       {"rough.ppm", "metal.ppm", "hole.ppm", "normal.ppm", "channel: \"G\"", "to: [0.25, 0.75]", "channel: \"R\"",
        "transfer: \"srgb\"", "transfer: \"linear\"", "flip_y: true", "MaskShader", "from: [0.249, 0.25]", "wrap_v: repeat"})
    EXPECT_NE(text.find(there), std::string::npos) << there << " is missing in\n" << text;
}

TEST_F(UsdTest, FacesHaveTheMaterialsOfTheirSubsetsAndHolesAreNone) {
  const Ref<Scene> s =
      scene(y_up + material("color3f inputs:emissiveColor = (1, 0, 0)\ncolor3f inputs:diffuseColor = (0, 0, 0)\n", "") +
            "def Material \"B\" {\ntoken outputs:surface.connect = </B/S.outputs:surface>\ndef Shader \"S\" {\nuniform token "
            "info:id = "
            "\"UsdPreviewSurface\"\ncolor3f inputs:emissiveColor = (0, 0, 1)\ncolor3f inputs:diffuseColor = (0, 0, 0)\ntoken "
            "outputs:surface\n}\n}\n"
            "def Mesh \"m\" (prepend apiSchemas = [\"MaterialBindingAPI\"]) {\nrel material:binding = </A>\nint[] "
            "faceVertexCounts = [4, 4, 4]\n"
            "int[] faceVertexIndices = [0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6]\nint[] holeIndices = [1]\npoint3f[] points = "
            "[(-1.5, -0.5, 0), "
            "(-0.5, -0.5, 0), (0.5, -0.5, 0), (1.5, -0.5, 0), (-1.5, 0.5, 0), (-0.5, 0.5, 0), (0.5, 0.5, 0), (1.5, 0.5, "
            "0)]\nuniform token "
            "subdivisionScheme = \"none\"\ndef GeomSubset \"g\" (prepend apiSchemas = [\"MaterialBindingAPI\"]) {\nuniform "
            "token elementType = "
            "\"face\"\nuniform token familyName = \"materialBind\"\nint[] indices = [2]\nrel material:binding = </B>\n}\n}\n");
  ASSERT_TRUE(s) << error_;
  size_t triangles = 0;
  for (const Ref<SceneObject>& object : s->objects) triangles += mesh_of(*object).triangles.size();
  EXPECT_EQ(triangles, 4u) << "two faces of four corners";
  const Image image = picture(s, "OrthographicCamera { from: [0, 0, 3], to: [0, 0, 0], width: 3 }", 3, 16);
  expect_rgb(image, 0, 1, {1, 0, 0}, 0.02);
  expect_rgb(image, 1, 1, {0, 0, 0}, 1e-6);
  expect_rgb(image, 2, 1, {0, 0, 1}, 0.02);
}

// ---- objects ----------------------------------------------------------------------------------------------------------------

TEST_F(UsdTest, InstancesStandWhereTheirInstancerPutsThemAndNowhereElse) {
  std::string positions, indices;
  for (int i = 0; i < 12; ++i) {
    positions += (i ? ", (" : "(") + std::to_string(2 * i) + ", 0, 0)";
    indices += i ? ", 0" : "0";
  }
  const Ref<Scene> s = scene(
      y_up + "def PointInstancer \"i\" {\nrel prototypes = [</i/p>]\nint64[] invisibleIds = [11]\nint[] protoIndices = [" +
      indices + "]\npoint3f[] positions = [" + positions +
      "]\ndef Mesh \"p\" { int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\npoint3f[] points = "
      "[(0, 0, 0), (1, 0, 0), (0, 1, 0)]\nuniform token subdivisionScheme = \"none\"\ndouble3 xformOp:translate = "
      "(0, 5, 0)\nuniform token[] xformOpOrder = [\"xformOp:translate\"]\n}\n}\n");
  ASSERT_TRUE(s) << error_;
  EXPECT_EQ(s->objects.size(), 11u);
  Bounds3 all;
  for (const Ref<SceneObject>& object : s->objects) {
    prepare_tree(*object);
    all.add(object->bounds());
  }
  EXPECT_NEAR(all.low.x, 0, 1e-5);
  EXPECT_NEAR(all.high.x, 21, 1e-5);
  EXPECT_NEAR(all.low.y, 5, 1e-5);
  EXPECT_NEAR(all.high.y, 6, 1e-5);
}

TEST_F(UsdTest, ShapesSmoothSurfacesAndCurvesAreThemselves) {
  const std::string cube =
      "def Mesh \"l\" {\nint[] faceVertexCounts = [4, 4, 4, 4, 4, 4]\nint[] faceVertexIndices = [0, 3, 2, 1, 4, 5, 6, 7, 0, 1, "
      "5, "
      "4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7]\npoint3f[] points = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, "
      "-1, "
      "1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]\n";
  struct Row {
    std::string object;
    Point3 high;
    float within;
  };
  const Row rows[] = {
      {"def Sphere \"l\" {\ndouble radius = 3\n}\n", {3, 3, 3}, 1e-5f},
      {"def Cube \"l\" {\n}\n", {1, 1, 1}, 1e-5f},
      {"def Cone \"l\" {\nuniform token axis = \"X\"\ndouble height = 4\n}\n", {2, 1, 1}, 1e-5f},
      {"def Cylinder \"l\" {\nuniform token axis = \"Y\"\ndouble height = 6\ndouble radius = 0.5\n}\n", {0.5f, 3, 0.5f}, 1e-5f},
      {"def Plane \"l\" {\ndouble width = 2\ndouble length = 8\n}\n", {1, 4, 0}, 1e-5f},
      // The middle of a face of a cube's cage m goes to (16 m + 4 (e1 + ... + e4) + p1 + ... + p4) / 36, with p the middles of
      // the faces around, as it is a point of four faces after one division: 5/6 and less.
      {cube + "}\n", {0.8333f, 0.8333f, 0.8333f}, 0.02f},
      {cube + "uniform token subdivisionScheme = \"none\"\n}\n", {1, 1, 1}, 1e-5f},
      // Sharp corners stay.
      {cube +
           "int[] cornerIndices = [0, 1, 2, 3, 4, 5, 6, 7]\nfloat[] cornerSharpnesses = [10, 10, 10, 10, 10, 10, 10, 10]\n}\n",
       {1, 1, 1},
       1e-4f},
      // A sharp edge around the upper face: a plane B-spline there, (23 + 23 - 1 - 1) / 48 wide in the middle of a side.
      {cube + "int[] creaseIndices = [4, 5, 6, 7, 4]\nint[] creaseLengths = [5]\nfloat[] creaseSharpnesses = [10]\n}\n",
       {0.9167f, 0.9167f, 1},
       0.01f},
      // A spline from the second to the third point, where it is parallel to the line between their neighbours: y = 4 t^3 - 6
      // t^2 + 2 t rises to 1 / (3 sqrt 3); an eighth of a unit around it.
      {"def BasisCurves \"l\" {\nint[] curveVertexCounts = [4]\npoint3f[] points = [(0, -4, 0), (1, 0, 0), (2, 0, 0), (3, 4, "
       "0)]\nfloat[] widths = "
       "[0.25] (interpolation = \"constant\")\nuniform token basis = \"catmullRom\"\n}\n",
       {2.125f, 0.3175f, 0.125f},
       0.03f},
  };
  std::vector<std::string> objects;
  for (const Row& row : rows) objects.push_back(row.object);
  size_t i = 0;
  of_each(y_up, objects, [&](const Ref<Scene>& s) {
    prepare_tree(*s->objects[0]);
    const Bounds3 box = s->objects[0]->bounds();
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(box.high[k], rows[i].high[k], rows[i].within) << rows[i].object << " axis " << k;
    ++i;
    return 0.0;
  });
  const Ref<Scene> capsule = scene(y_up + "def Capsule \"c\" {\ndouble height = 2\ndouble radius = 0.5\n}\n");
  ASSERT_TRUE(capsule) << error_;
  Bounds3 box;
  for (const Ref<SceneObject>& object : capsule->objects) {
    prepare_tree(*object);
    box.add(object->bounds());
  }
  EXPECT_NEAR(box.high.z, 1.5, 1e-5);
}

TEST_F(UsdTest, WhatMovesIsReadAtItsTimeAndKeepsItInItsName) {
  const std::string text =
      "#usda 1.0\n( upAxis = \"Y\"\n metersPerUnit = 1\n startTimeCode = 0\n endTimeCode = 48\n timeCodesPerSecond = 24 )\ndef "
      "Mesh \"m\" "
      "{ int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\npoint3f[] points.timeSamples = { 0: [(0, 0, 0), "
      "(1, 0, 0), (0, "
      "1, 0)], 48: [(0, 0, 0), (5, 0, 0), (0, 1, 0)] }\nuniform token subdivisionScheme = \"none\"\n}\n";
  const std::string path = folder_.write("moving.usda", text);  // once: what was read of it is kept for its other times
  const auto widest = [&](double time) {
    ImportOptions options;
    options.time = time;
    const Ref<Scene> s = scene_of(path, options);
    if (!s) return -1.0;
    float most = 0;
    for (const Point3& p : mesh_of(*s->objects[0]).positions) most = std::max(most, p.x);
    return double(most);
  };
  EXPECT_NEAR(widest(0), 1, 1e-6);
  EXPECT_NEAR(widest(1), 3, 1e-6);
  EXPECT_NEAR(widest(2), 5, 1e-6);
}

TEST_F(UsdTest, SkinsAreBentByTheirSkeletons) {
  // A joint that moves by 10 along z in a second: after half of that the mesh, all of whose weight is on it, has moved by 5.
  const std::string text =
      "#usda 1.0\n( upAxis = \"Y\"\n metersPerUnit = 1\n startTimeCode = 0\n endTimeCode = 24\n timeCodesPerSecond = 24 )\ndef "
      "SkelRoot "
      "\"r\" {\ndef Skeleton \"k\" (prepend apiSchemas = [\"SkelBindingAPI\"]) {\nuniform matrix4d[] bindTransforms = [((1, 0, "
      "0, 0), (0, 1, "
      "0, 0), (0, 0, 1, 0), (0, 0, 0, 1))]\nuniform token[] joints = [\"j\"]\nuniform matrix4d[] restTransforms = [((1, 0, 0, "
      "0), (0, 1, 0, "
      "0), (0, 0, 1, 0), (0, 0, 0, 1))]\nrel skel:animationSource = </r/a>\n}\ndef SkelAnimation \"a\" {\nuniform token[] "
      "joints = "
      "[\"j\"]\nquatf[] rotations = [(1, 0, 0, 0)]\nhalf3[] scales = [(1, 1, 1)]\nfloat3[] translations.timeSamples = { 0: "
      "[(0, 0, 0)], 24: "
      "[(0, 0, 10)] }\n}\ndef Mesh \"m\" (prepend apiSchemas = [\"SkelBindingAPI\"]) {\nint[] faceVertexCounts = [3]\nint[] "
      "faceVertexIndices = [0, 1, 2]\npoint3f[] points = [(0, 0, 1), (1, 0, 1), (0, 1, 1)]\nint[] primvars:skel:jointIndices = "
      "[0, 0, 0] "
      "(elementSize = 1\ninterpolation = \"vertex\")\nfloat[] primvars:skel:jointWeights = [1, 1, 1] (elementSize = "
      "1\ninterpolation = "
      "\"vertex\")\nrel skel:skeleton = </r/k>\nuniform token subdivisionScheme = \"none\"\n}\n}\n";
  ImportOptions options;
  options.time = 0.5;
  const Ref<Scene> s = scene(text, options);
  ASSERT_TRUE(s) << error_;
  prepare_tree(*s->objects[0]);
  EXPECT_NEAR(s->objects[0]->bounds().low.z, 6, 1e-4);
}

TEST_F(UsdTest, CamerasHaveTheirLensAndTheirShift) {
  ASSERT_TRUE(
      scene(y_up +
            "def Sphere \"s\" {}\ndef Camera \"c\" { float fStop = 2\nfloat focusDistance = 7\nfloat focalLength = 40\nfloat "
            "horizontalAperture = 20\nfloat verticalAperture = 10\nfloat horizontalApertureOffset = 5\n}\n"));
  ASSERT_TRUE(job_);
  const std::string text = write_description(*job_);
  // 40 tenths of a unit over twice 2: a radius of one unit; the picture is twice as wide as high, and reaches from -5 to 15.
  for (const char* there : {"lens_radius: 1", "focus_distance: 7", "principal_point: [-0.25, 0]"})
    EXPECT_NE(text.find(there), std::string::npos) << there << " is missing in\n" << text;
}

// ---- what may not be read
// -----------------------------------------------------------------------------------------------------

TEST_F(UsdTest, LayersOutsideOfTheFolderAreNotOpened) {
  const TemporaryFolder other;
  const std::string secret = other.write("secret.usda", y_up + "def Sphere \"s\" { double radius = 3\n}\n");
  for (const std::string& text : {"def \"w\" ( prepend references = @" + secret + "@</s> ) {}\n",
                                  "def \"w\" ( prepend payload = @" + secret + "@</s> ) {}\n",
                                  std::string("def \"w\" ( variants = { string v = \"a\" }\n prepend variantSets = \"v\" ) {\n "
                                              "variantSet \"v\" = {\n \"a\" {\n}\n \"b\" ( prepend "
                                              "references = @") +
                                      secret + "@</s> ) {\n}\n }\n}\n"}) {
    EXPECT_FALSE(scene(y_up + text));
    EXPECT_NE(error_.find("--allow-path"), std::string::npos) << error_ << "\n" << text;
  }
  std::filesystem::create_symlink(secret, folder_ / "link.usda");
  EXPECT_FALSE(scene(y_up + "def \"w\" ( prepend references = @link.usda@</s> ) {}\n"));
  EXPECT_FALSE(scene("#usda 1.0\n( subLayers = [ @" + secret + "@ ] )\n"));
  ImportOptions allowed;
  allowed.allowed_folders = {other.path()};
  EXPECT_TRUE(scene(y_up + "def \"w\" ( prepend references = @" + secret + "@</s> ) {}\n", allowed)) << error_;
}

TEST_F(UsdTest, WhatIsDamagedIsRefusedByItsPlace) {
  EXPECT_FALSE(scene(y_up + "def Mesh \"m\" {"));
  EXPECT_NE(error_.find(":4:"), std::string::npos) << error_;
  EXPECT_FALSE(scene(
      y_up +
      "def Mesh \"m\" { int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 7]\npoint3f[] points = [(0, 0, 0), "
      "(1, 0, 0), (0, 1, 0)]\n}\n"));
  EXPECT_NE(error_.find("/m"), std::string::npos) << error_;
  EXPECT_FALSE(scene(""));
  EXPECT_FALSE(scene("#usda 1.0\n( metersPerUnit = 0 )\ndef Sphere \"s\" {}\n"));
  // What is not there is told, and the rest shown.
  EXPECT_TRUE(scene(y_up + "def Sphere \"s\" {}\ndef \"w\" ( prepend references = @gone.usda@ ) {}\n")) << error_;
  EXPECT_TRUE(told("gone.usda"));
}

}  // namespace
}  // namespace etendue
