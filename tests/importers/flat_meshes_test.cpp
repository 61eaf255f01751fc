// Meshes without area, among other objects, in files of all formats: they are left out with a warning, and the rest is read.

#include <gtest/gtest.h>

#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "support/process.h"

namespace etendue {
namespace {

const std::string flat_ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n";

struct Prepared {
  Ref<Job> job;
  std::string told;
};
Prepared prepared(const std::string& path) {
  testing::internal::CaptureStderr();
  Prepared result;
  try {
    result.job = load_job(path);
    prepare_tree(*result.job);
  } catch (const Errors& e) {
    result.told = std::string(e.what()) + "\n";
    result.job = nullptr;
  } catch (const Error& e) {
    result.told = std::string(e.what()) + "\n";
    result.job = nullptr;
  }
  result.told += testing::internal::GetCapturedStderr();
  return result;
}
void expect_left_out(const std::string& path, const std::string& of) {
  const Prepared p = prepared(path);
  ASSERT_TRUE(p.job) << path << ": " << p.told;
  EXPECT_NE(p.told.find(of + "': none of its 1 triangles can be used"), std::string::npos) << p.told;
  EXPECT_NE(p.told.find("it is left out"), std::string::npos) << p.told;
  EXPECT_NEAR(double(p.job->scene->radius()), std::sqrt(3), 0.1) << path;  // of the ball, or of an object as large
}

TEST(FlatMeshes, OfPbrt) {
  const TemporaryFolder folder;
  folder.write("flat.ply", flat_ply);
  const std::string head = "Camera \"perspective\" Film \"image\" WorldBegin LightSource \"infinite\"\nShape \"sphere\"\n";
  expect_left_out(folder.write("a.pbrt", head + "Shape \"plymesh\" \"string filename\" \"flat.ply\"\n"), "flat.ply");
  // A flat mesh is no luminaire, but the scene's other lights are.
  const Prepared lamp = prepared(
      folder.write("b.pbrt", head + "AreaLightSource \"diffuse\" Shape \"plymesh\" \"string filename\" \"flat.ply\"\n"));
  ASSERT_TRUE(lamp.job) << lamp.told;
  EXPECT_EQ(lamp.job->scene->luminaires().size(), 1u);
  // So flat that its height vanishes in floats.
  const Prepared thin = prepared(folder.write(
      "c.pbrt", head + "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 .5 1e-9 0]\n"));
  ASSERT_TRUE(thin.job) << thin.told;
  for (const std::string type :
       {"\"loopsubdiv\" \"integer indices\" [0 1 2]", "\"bilinearmesh\" \"integer indices\" [0 1 2 0]"}) {
    const Prepared flat =
        prepared(folder.write(type.substr(1, 4) + ".pbrt", head + "Shape " + type + " \"point P\" [0 0 0 1 0 0 2 0 0]\n"));
    ASSERT_TRUE(flat.job) << flat.told;
    EXPECT_NE(flat.told.find("have no area is left out"), std::string::npos) << flat.told;
  }
  EXPECT_NE(thin.told.find("have no area is left out"), std::string::npos) << thin.told;
}

TEST(FlatMeshes, OfMitsuba) {
  const TemporaryFolder folder;
  folder.write("flat.ply", flat_ply);
  folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  for (const std::string type : {"ply", "obj"})
    expect_left_out(folder.write(type + ".xml",
                                 "<scene version=\"3.0.0\"><integrator type=\"path\"/><sensor type=\"perspective\"/>"
                                 "<emitter type=\"constant\"/><shape type=\"sphere\"/><shape type=\"" +
                                     type + "\"><string name=\"filename\" value=\"flat." + type +
                                     "\"/><emitter type=\"area\"/></shape></scene>"),
                    "flat." + type);
}

TEST(FlatMeshes, OfObjAndGltf) {
  const TemporaryFolder folder;
  folder.write("a.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n");
  const std::string obj =
      folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 2 2\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n");
  expect_left_out(obj, "a.obj");
  // Two triangles over the same four vertices.
  std::string bytes;
  for (const float x : std::initializer_list<float>{0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 2, 2})
    bytes.append(reinterpret_cast<const char*>(&x), 4);
  for (const std::uint16_t i : std::initializer_list<std::uint16_t>{0, 1, 2, 0, 2, 3})
    bytes.append(reinterpret_cast<const char*>(&i), 2);
  folder.write("a.bin", bytes);
  expect_left_out(
      folder.write(
          "a.gltf",
          R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[
{"attributes":{"POSITION":0},"indices":1},{"attributes":{"POSITION":0},"indices":2}]}],"buffers":[{"uri":"a.bin","byteLength":60}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":6},{"buffer":0,"byteOffset":54,"byteLength":6}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[2,2,2]},
{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},{"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"}]})"),
      "a.gltf");
}

TEST(FlatMeshes, OfDescriptions) {
  const TemporaryFolder folder;
  folder.write("flat.ply", flat_ply);
  const std::string job =
      "Job { camera: PerspectiveCamera {}, scene: BvhScene { objects: [ Sphere { shader: Lambertian {} },\n MESH ] } }";
  const auto with = [&](const std::string& mesh) {
    std::string text = job;
    return folder.write("a.etd", text.replace(text.find("MESH"), 4, mesh));
  };
  expect_left_out(with("TriangleMesh { file: \"flat.ply\", emission: DiffuseEmission {} }"), "flat.ply");
  // If the numbers stand in the description itself, they are an error.
  EXPECT_FALSE(prepared(with("TriangleMesh { positions: [[0, 0, 0], [1, 0, 0], [2, 0, 0]] m, triangles: [0, 1, 2] }")).job);
}

}  // namespace
}  // namespace etendue
