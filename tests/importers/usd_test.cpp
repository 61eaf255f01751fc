// Objects and cameras of USD, and files that may not be read.

#include "support/image_file.h"
#include "usd_support.h"

namespace etendue {
namespace {

using test::expect_rgb;
using test::rgb;
using test::y_up;
using UsdObjects = test::UsdTest;

TEST_F(UsdObjects, InstancesStandWhereTheirInstancerPutsThemAndNowhereElse) {
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

// Instance i has entry i of each list, and what a list does not have for it is left out or neutral. The instances of a unit
// square, by their boxes along x and y.
TEST_F(UsdObjects, InstancersMayHaveListsOfDifferentLengths) {
  struct Row {
    std::string lists, told;
    std::vector<Bounds3> boxes;
  };
  const auto box = [](float x0, float y0, float x1, float y1) { return Bounds3{{x0, y0, 0}, {x1, y1, 0}}; };
  const std::string positions = "point3f[] positions = [(0, 0, 0), (2, 0, 0), (4, 0, 0)]\n";
  const Bounds3 first = box(0, 5, 1, 6), second = box(2, 5, 3, 6), third = box(4, 5, 5, 6);
  const Row rows[] = {
      {"point3f[] positions = [(0, 0, 0), (2, 0, 0)]\n", "number of positions", {first, second}},
      {"point3f[] positions = [(0, 0, 0), (2, 0, 0), (4, 0, 0), (6, 0, 0)]\n", "number of positions", {first, second, third}},
      {"", "number of positions", {}},
      // A half turn about z, of the prototype at (0, 5) too.
      {positions + "quath[] orientations = [(0, 0, 0, 1)]\n", "number of orientations", {box(-1, -6, 0, -5), second, third}},
      {positions + "quath[] orientations = [(0, 0, 0, 1), (1, 0, 0, 0), (1, 0, 0, 0), (0, 0, 0, 1)]\n",
       "number of orientations",
       {box(-1, -6, 0, -5), second, third}},
      {positions + "float3[] scales = [(3, 2, 1), (1, 1, 1)]\n", "number of scales", {box(0, 10, 3, 12), second, third}},
      {positions + "int64[] ids = [7, 8]\nint64[] invisibleIds = [8]\n", "number of ids", {first, third}}};
  for (const Row& row : rows) {
    const Ref<Scene> s =
        scene(y_up + "def PointInstancer \"i\" {\nrel prototypes = [</i/p>]\nint[] protoIndices = [0, 0, 0]\n" + row.lists +
              "def Mesh \"p\" { int[] faceVertexCounts = [4]\nint[] faceVertexIndices = [0, 1, 2, 3]\npoint3f[] "
              "points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]\nuniform token subdivisionScheme = "
              "\"none\"\ndouble3 xformOp:translate = (0, 5, 0)\nuniform token[] xformOpOrder = "
              "[\"xformOp:translate\"]\n}\n}\n");
    ASSERT_TRUE(s) << row.lists << error_;
    EXPECT_TRUE(told(row.told)) << row.lists;
    ASSERT_EQ(s->objects.size(), row.boxes.size()) << row.lists;
    for (size_t i = 0; i < row.boxes.size(); ++i) {
      prepare_tree(*s->objects[i]);
      const Bounds3 got = s->objects[i]->bounds();
      for (int k = 0; k < 2; ++k) {
        EXPECT_NEAR(got.low[k], row.boxes[i].low[k], 1e-4f) << row.lists << i;
        EXPECT_NEAR(got.high[k], row.boxes[i].high[k], 1e-4f) << row.lists << i;
      }
    }
  }
}

TEST_F(UsdObjects, ShapesSmoothSurfacesAndCurvesAreThemselves) {
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
      // The middle m of a face of a cube's cage goes to (16 m + 4 (e1 + ... + e4) + p1 + ... + p4) / 36, with p the middles of
      // the faces around, because after one subdivision it is a vertex of four faces: 5/6 and less.
      {cube + "}\n", {0.8333f, 0.8333f, 0.8333f}, 0.02f},
      {cube + "uniform token subdivisionScheme = \"none\"\n}\n", {1, 1, 1}, 1e-5f},
      // Sharp corners stay.
      {cube +
           "int[] cornerIndices = [0, 1, 2, 3, 4, 5, 6, 7]\nfloat[] cornerSharpnesses = [10, 10, 10, 10, 10, 10, 10, 10]\n}\n",
       {1, 1, 1},
       1e-4f},
      // A sharp edge around the upper face: a planar B-spline there, (23 + 23 - 1 - 1) / 48 wide in the middle of a side.
      {cube + "int[] creaseIndices = [4, 5, 6, 7, 4]\nint[] creaseLengths = [5]\nfloat[] creaseSharpnesses = [10]\n}\n",
       {0.9167f, 0.9167f, 1},
       0.01f},
      // A spline from the second to the third point, where its tangents are parallel to the line between the neighbouring
      // points: y = 4 t^3 - 6 t^2 + 2 t rises to 1 / (3 sqrt 3); its radius is an eighth of a unit.
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

TEST_F(UsdObjects, WhatMovesIsReadAtItsTimeAndKeepsItInItsName) {
  const std::string text =
      "#usda 1.0\n( upAxis = \"Y\"\n metersPerUnit = 1\n startTimeCode = 0\n endTimeCode = 48\n timeCodesPerSecond = 24 )\ndef "
      "Mesh \"m\" "
      "{ int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\npoint3f[] points.timeSamples = { 0: [(0, 0, 0), "
      "(1, 0, 0), (0, "
      "1, 0)], 48: [(0, 0, 0), (5, 0, 0), (0, 1, 0)] }\nuniform token subdivisionScheme = \"none\"\n}\n";
  const std::string path = folder_.write("moving.usda", text);  // one file: it is cached for its other times
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

TEST_F(UsdObjects, SkinsAreBentByTheirSkeletons) {
  // A joint that moves by 10 along z in a second: after half of that time the mesh, whose whole weight is on the joint, has
  // moved by 5.
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

TEST_F(UsdObjects, BlendShapesMovePointsByTheirWeights) {
  // After half a second "up" has the weight 0.75, half way from a shape in between at 0.5, which moves by 1 along z, to its
  // own, by 2 along y; "wide" has 0.5 of 1 along x. The joint then lifts all by 3.
  const std::string text =
      "#usda 1.0\n( upAxis = \"Y\"\n metersPerUnit = 1\n startTimeCode = 0\n endTimeCode = 10\n timeCodesPerSecond = 10 )\ndef "
      "SkelRoot \"r\" {\ndef Skeleton \"k\" (prepend apiSchemas = [\"SkelBindingAPI\"]) {\nuniform token[] joints = "
      "[\"j\"]\nuniform matrix4d[] bindTransforms = [((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))]\nuniform "
      "matrix4d[] restTransforms = [((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))]\nrel skel:animationSource = "
      "</r/a>\n}\ndef SkelAnimation \"a\" {\nuniform token[] blendShapes = [\"other\", \"up\", \"wide\"]\nfloat[] "
      "blendShapeWeights.timeSamples = { 0: [1, 0, 0], 10: [0, 1.5, 1] }\nuniform token[] joints = [\"j\"]\nfloat3[] "
      "translations "
      "= [(0, 0, 3)]\nquatf[] rotations = [(1, 0, 0, 0)]\nhalf3[] scales = [(1, 1, 1)]\n}\ndef Mesh \"m\" (prepend apiSchemas "
      "= "
      "[\"SkelBindingAPI\"]) {\nint[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\npoint3f[] points = [(0, 0, "
      "0), "
      "(1, 0, 0), (1, 1, 0)]\nuniform token[] skel:blendShapes = [\"wide\", \"up\"]\nrel skel:blendShapeTargets = "
      "[</r/m/wide>, "
      "</r/m/up>]\nrel skel:skeleton = </r/k>\nint[] primvars:skel:jointIndices = [0, 0, 0] (elementSize = 1\ninterpolation = "
      "\"vertex\")\nfloat[] primvars:skel:jointWeights = [1, 1, 1] (elementSize = 1\ninterpolation = \"vertex\")\nuniform "
      "token "
      "subdivisionScheme = \"none\"\ndef BlendShape \"wide\" {\nuniform vector3f[] offsets = [(1, 0, 0), (1, 0, 0)]\nuniform "
      "int[] pointIndices = [1, 2]\n}\ndef BlendShape \"up\" {\nuniform vector3f[] offsets = [(0, 0, 0), (0, 0, 0), (0, 2, "
      "0)]\nuniform vector3f[] inbetweens:half = [(0, 0, 0), (0, 0, 0), (0, 0, 1)] (\nweight = 0.5\n)\n}\n}\n}\n";
  ImportOptions options;
  options.time = 0.5;
  const Ref<Scene> s = scene(text, options);
  ASSERT_TRUE(s) << error_;
  EXPECT_TRUE(notes_.empty()) << notes_.front();
  const std::vector<Point3> points = mesh_of(*s->objects[0]).positions, wanted = {{0, 0, 3}, {1.5f, 0, 3}, {1.5f, 2, 3.5f}};
  ASSERT_EQ(points.size(), wanted.size());
  for (size_t i = 0; i < wanted.size(); ++i) EXPECT_LT(distance(points[i], wanted[i]), 1e-5f) << i;
}

TEST_F(UsdObjects, CamerasHaveTheirLensAndTheirShift) {
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

// ---- what may not be read ---------------------------------------------------------------------------------------------------

TEST_F(UsdObjects, LayersOutsideOfTheFolderAreNotOpened) {
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

TEST_F(UsdObjects, WhatIsDamagedIsRefusedByItsPlace) {
  EXPECT_FALSE(scene(y_up + "def Mesh \"m\" {"));
  EXPECT_NE(error_.find(":4:"), std::string::npos) << error_;
  EXPECT_FALSE(scene(
      y_up +
      "def Mesh \"m\" { int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 7]\npoint3f[] points = [(0, 0, 0), "
      "(1, 0, 0), (0, 1, 0)]\n}\n"));
  EXPECT_NE(error_.find("/m"), std::string::npos) << error_;
  EXPECT_FALSE(scene(""));
  EXPECT_FALSE(scene("#usda 1.0\n( metersPerUnit = 0 )\ndef Sphere \"s\" {}\n"));
  // Missing files are reported, and the rest is read.
  EXPECT_TRUE(scene(y_up + "def Sphere \"s\" {}\ndef \"w\" ( prepend references = @gone.usda@ ) {}\n")) << error_;
  EXPECT_TRUE(told("gone.usda"));
}

// Hydra renders prototypes that are defined below an 'over'.
TEST_F(UsdObjects, PrototypesMayStandBelowAnOver) {
  const auto instanced = [&](const std::string& around) {
    return scene(y_up +
                 "def PointInstancer \"i\" {\nrel prototypes = [</i/all/p>]\nint[] protoIndices = [0, 0]\npoint3f[] "
                 "positions = [(0, 0, 0), (3, 0, 0)]\n" +
                 around +
                 " \"all\" {\ndef Mesh \"p\" { int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\npoint3f[] "
                 "points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\nuniform token subdivisionScheme = \"none\"\n}\n}\n}\n");
  };
  const Ref<Scene> below = instanced("over");
  ASSERT_TRUE(below) << error_;
  EXPECT_EQ(below->objects.size(), 2u);
  const Ref<Scene> in_class = instanced("class");
  ASSERT_TRUE(in_class) << error_;
  EXPECT_TRUE(in_class->objects.empty());
  EXPECT_TRUE(told("are classes"));
}

TEST_F(UsdObjects, ConcavePolygonsKeepTheirShape) {
  for (const char* corners : {"0, 1, 2, 3, 4", "3, 4, 0, 1, 2", "1, 2, 3, 4, 0"}) {
    const Ref<Scene> s = scene(y_up + "def Mesh \"p\" { int[] faceVertexCounts = [5]\nint[] faceVertexIndices = [" + corners +
                               "]\npoint3f[] points = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (2, 1, 0), (0, 4, 0)]\nuniform token "
                               "subdivisionScheme = \"none\"\n}\n");
    ASSERT_TRUE(s) << error_;
    const MeshData mesh = mesh_of(*s->objects.at(0));
    ASSERT_EQ(mesh.triangles.size(), 3u);
    float area = 0;
    for (const auto& t : mesh.triangles)
      area += length(cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]])) / 2;
    EXPECT_NEAR(area, 10, 1e-4) << corners;
  }
}

TEST_F(UsdObjects, ImagesInSeveralFiles) {
  test::write_image(folder_ / "t.1001.png", {1, 1, 3, NumberType::uint8}, {1, 0, 0});
  test::write_image(folder_ / "t.1002.png", {1, 1, 3, NumberType::uint8}, {0, 1, 0});
  const Ref<Scene> s = scene(
      y_up +
      "def Mesh \"p\" (prepend apiSchemas = [\"MaterialBindingAPI\"]) { int[] faceVertexCounts = [4]\nint[] faceVertexIndices "
      "= "
      "[0, 1, 2, 3]\npoint3f[] points = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0)]\nuniform token subdivisionScheme = "
      "\"none\"\ntexCoord2f[] primvars:st = [(0, 0), (2, 0), (2, 1), (0, 1)] (interpolation = \"vertex\")\nrel "
      "material:binding = </m>\n}\n"
      "def Material \"m\" {\ntoken outputs:surface.connect = </m/s.outputs:surface>\ndef Shader \"s\" {\nuniform token info:id "
      "= "
      "\"UsdPreviewSurface\"\ncolor3f inputs:diffuseColor.connect = </m/t.outputs:rgb>\ntoken outputs:surface\n}\ndef Shader "
      "\"t\" {\nuniform token info:id = \"UsdUVTexture\"\nasset inputs:file = @t.<UDIM>.png@\ncolor3f outputs:rgb\n}\n}\n");
  ASSERT_TRUE(s) << error_;
  EXPECT_TRUE(notes_.empty()) << notes_[0];
  const Image seen = picture(s, "OrthographicCamera { from: [1, 0.5, 2], to: [1, 0.5, 0], width: 2 }", 8, 16,
                             "Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: rgb(1, 1, 1) } }");
  const std::array<double, 3> left = rgb(seen, 1, 4), right = rgb(seen, 6, 4);
  EXPECT_GT(left[0], 5 * left[1]);
  EXPECT_GT(right[1], 5 * right[0]);
}

}  // namespace
}  // namespace etendue
