// Skins of USD with stated normals: bent by joints, rotated by blend shapes, and in instances.

#include "usd_support.h"

namespace etendue {
namespace {

using test::y_up;
using UsdSkins = test::UsdTest;

/// A quad with a skeleton of two joints, the first of which has all the weight and is rotated by 90 degrees about y: x goes to
/// -z and z to x.
std::string skinned(const std::string& normals, const std::string& more = "", const std::string& influences = "") {
  const std::string vertex =
      "int[] primvars:skel:jointIndices = [0, 1, 0, 1, 0, 1, 0, 1] (\nelementSize = 2\ninterpolation = \"vertex\"\n)\n"
      "float[] primvars:skel:jointWeights = [1, 0, 1, 0, 1, 0, 1, 0] (\nelementSize = 2\ninterpolation = \"vertex\"\n)\n";
  return "def SkelRoot \"r\" {\ndef Skeleton \"k\" (\nprepend apiSchemas = [\"SkelBindingAPI\"]\n) {\nuniform token[] joints = "
         "[\"j\", \"j/i\"]\nuniform matrix4d[] bindTransforms = [((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)), "
         "((1, "
         "0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))]\nuniform matrix4d[] restTransforms = [((1, 0, 0, 0), (0, 1, 0, "
         "0), (0, 0, 1, 0), (0, 0, 0, 1)), ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))]\nrel skel:animationSource "
         "= </r/a>\n}\ndef SkelAnimation \"a\" {\nuniform token[] joints = [\"j\"]\nquatf[] rotations = [(0.70710678, 0, "
         "0.70710678, 0)]\nhalf3[] scales = [(1, 1, 1)]\nfloat3[] translations = [(0, 0, 0)]\nuniform token[] blendShapes = "
         "[\"up\"]\nfloat[] blendShapeWeights = [0.5]\n}\ndef Mesh \"m\" (\nprepend apiSchemas = [\"SkelBindingAPI\"]\n) "
         "{\nint[] faceVertexCounts = [4]\nint[] faceVertexIndices = [0, 1, 2, 3]\npoint3f[] points = [(0, 0, 0), (1, 0, 0), "
         "(1, 1, 0), (0, 1, 0)]\nuniform token subdivisionScheme = \"none\"\nrel skel:skeleton = </r/k>\n" +
         (influences.empty() ? vertex : influences) + normals + more + "}\n}\n";
}

std::string list(const std::string& one, int count) {
  std::string all = one;
  for (int i = 1; i < count; ++i) all += ", " + one;
  return all;
}

void expect_normals(const MeshData& mesh, const Vector3& wanted, const std::string& what) {
  ASSERT_FALSE(mesh.normals.empty()) << what;
  for (const Normal3& n : mesh.normals) EXPECT_LT(length(Vector3(n) - normalize(wanted)), 1e-4f) << what;
}

// A mesh that its geomBindTransform makes twice as long along x: a normal's component along x is halved, and then everything is
// rotated.
TEST_F(UsdSkins, StatedNormalsAreBentWithTheSurface) {
  const std::string bind =
      "matrix4d primvars:skel:geomBindTransform = ((2, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))\n";
  const std::string rigid =
      "int[] primvars:skel:jointIndices = [0, 1] (\nelementSize = 2\ninterpolation = \"constant\"\n)\nfloat[] "
      "primvars:skel:jointWeights = [1, 0] (\nelementSize = 2\ninterpolation = \"constant\"\n)\n";
  // All in one file, each with a skeleton and an animation of its own.
  std::string text = y_up;
  std::vector<std::string> rows;
  for (const auto& [how, count] : {std::pair{"vertex", 4}, {"varying", 4}, {"faceVarying", 4}, {"uniform", 1}, {"constant", 1}})
    for (const char* name : {"normals", "primvars:normals"})
      for (const char* method : {"classicLinear", "dualQuaternion"})
        for (const std::string& influences : {std::string(), rigid}) {
          // Rigid skins and the other skinning method are tested with one kind of normals only.
          if ((!influences.empty() || method[0] == 'd') && std::string(how) != "vertex") continue;
          std::string one = skinned(std::string("normal3f[] ") + name + " = [" + list("(0.6, 0, 0.8)", count) +
                                        "] (interpolation = \"" + how + "\")\n",
                                    bind + "uniform token primvars:skel:skinningMethod = \"" + method + "\"\n", influences);
          const std::string root = "r" + std::to_string(rows.size());
          one.replace(one.find("\"r\""), 3, "\"" + root + "\"");
          for (size_t at = 0; (at = one.find("</r/", at)) != std::string::npos; at += root.size())
            one.replace(at, 4, "</" + root + "/");
          text += one;
          rows.push_back(std::string(how) + " " + name + " " + method + (influences.empty() ? "" : " rigid"));
        }
  const Ref<Scene> s = scene(text);
  ASSERT_TRUE(s) << error_;
  EXPECT_TRUE(notes_.empty()) << notes_[0];
  ASSERT_EQ(s->objects.size(), rows.size());
  for (size_t i = 0; i < rows.size(); ++i) {
    const MeshData mesh = mesh_of(*s->objects[i]);
    expect_normals(mesh, {0.8f, 0, -0.3f}, rows[i]);
    Bounds3 box;
    for (const Point3& p : mesh.positions) box.add(p);
    EXPECT_NEAR(box.low.z, -2, 1e-4) << rows[i];
  }
}

// A mesh may list the joints that move it in an order of its own, or only some of them: here the second of its joints, and the
// only one, is the skeleton's first, which is rotated.
TEST_F(UsdSkins, MeshesOrderJointsThemselves) {
  const auto row = [](const std::string& joints, const std::string& indices, const std::string& weights) {
    const std::string four = "] (\nelementSize = 2\ninterpolation = \"vertex\"\n)\n";
    std::string text = skinned("uniform token[] skel:joints = [" + joints + "]\n", "",
                               "int[] primvars:skel:jointIndices = [" + list(indices, 4) + four +
                                   "float[] primvars:skel:jointWeights = [" + list(weights, 4) + four);
    const std::string nested = "\"j/i\"";
    return text.replace(text.find(nested), nested.size(), "\"i\"");
  };
  for (const std::string& text : {row("\"i\", \"j\"", "0, 1", "0, 1"), row("\"j\"", "0, 0", "1, 0")}) {
    const Ref<Scene> s = scene(y_up + text);
    ASSERT_TRUE(s) << error_;
    EXPECT_TRUE(notes_.empty()) << notes_[0];
    Bounds3 box;
    for (const Point3& p : mesh_of(*s->objects.at(0)).positions) box.add(p);
    EXPECT_NEAR(box.low.z, -1, 1e-4) << text;
    EXPECT_NEAR(box.high.x, 0, 1e-4) << text;
  }
}

// Half of an offset is added to a normal before it is bent. For a blend shape without normal offsets the normal follows the
// surface, which the shape tilts from +z to +x by 45 degrees: it lifts two corners by half of -2 along z.
TEST_F(UsdSkins, BlendShapesTurnNormals) {
  const std::string normals =
      "normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)] (interpolation = \"vertex\")\n";
  const auto shape = [](const std::string& of_normals) {
    return "uniform token[] skel:blendShapes = [\"up\"]\nrel skel:blendShapeTargets = [</r/m/up>]\ndef BlendShape \"up\" {\n"
           "uniform vector3f[] offsets = [(0, 0, -2), (0, 0, -2)]\nuniform int[] pointIndices = [1, 2]\n" +
           of_normals + "}\n";
  };
  const Ref<Scene> stated =
      scene(y_up + skinned(normals, shape("uniform vector3f[] normalOffsets = [(0, 2, 0), (0, 2, 0)]\n")));
  ASSERT_TRUE(stated) << error_;
  const MeshData mesh = mesh_of(*stated->objects.at(0));
  ASSERT_EQ(mesh.normals.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    const Vector3 wanted = i == 1 || i == 2 ? normalize(Vector3{1, 1, 0}) : Vector3{1, 0, 0};
    EXPECT_LT(length(Vector3(mesh.normals[i]) - wanted), 1e-4f) << i;
  }
  const Ref<Scene> turned = scene(y_up + skinned(normals, shape("")));
  ASSERT_TRUE(turned) << error_;
  expect_normals(mesh_of(*turned->objects.at(0)), {1, 0, -1}, "without offsets of normals");
}

// Each instance has its own skeleton's pose; shared data is written once.
TEST_F(UsdSkins, SkinsInInstancesAreBentToo) {
  folder_.write(
      "one.usda", y_up + "def Xform \"w\" {\n" + [] {
        std::string text = skinned("normal3f[] normals = [(0, 0, 1)] (interpolation = \"constant\")\n");
        for (size_t at = 0; (at = text.find("</r/", at)) != std::string::npos; at += 4) text.replace(at, 4, "</w/r/");
        return text;
      }() + "}\n");
  const std::string instance = "( instanceable = true\nreferences = @one.usda@</w>\n) {\n}\n";
  const Ref<Scene> s = scene(y_up + "def \"a\" " + instance + "def \"b\" " + instance);
  ASSERT_TRUE(s) << error_;
  ASSERT_EQ(s->objects.size(), 2u);
  EXPECT_TRUE(notes_.empty()) << notes_[0];
  for (const Ref<SceneObject>& object : s->objects) expect_normals(mesh_of(*object), {1, 0, 0}, "in an instance");
}

}  // namespace
}  // namespace etendue
