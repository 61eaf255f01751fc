// Materials of USD: the words and formulas of UsdPreviewSurface, against rendered values.

#include "usd_support.h"

namespace etendue {
namespace {

using test::expect_rgb;
using test::rgb;
using test::y_up;
using UsdMaterials = test::UsdTest;

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

TEST_F(UsdMaterials, TexturesAreScaledBiasedMovedAndMultipliedInRgb) {
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
  // A quarter of the side is the centre of a texel. The texture is shifted by half, so that left and right are exchanged. In
  // the mean over the four pixels around the centre, the neighbouring texels have a weight of an eighth along each axis.
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

TEST_F(UsdMaterials, EachTextureIsReadFromItsOwnImageAndChannel) {
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

TEST_F(UsdMaterials, FacesHaveTheMaterialsOfTheirSubsetsAndHolesAreNone) {
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

}  // namespace
}  // namespace etendue
