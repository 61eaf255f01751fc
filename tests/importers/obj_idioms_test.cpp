// What real files of OBJ, OFF and PLY hold besides triangles, and odd lines in them.

#include <algorithm>

#include "components/objects/meshes/mesh_data.h"
#include "gltf_support.h"
#include "support/image_file.h"

namespace etendue {
namespace {

using mitsuba_test::part;

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

struct Read {
  Ref<Scene> scene;
  std::vector<std::string> told;
  bool has(const std::string& words) const {
    return std::ranges::any_of(told, [&](const std::string& t) { return t.find(words) != std::string::npos; });
  }
};
Read import(const std::string& path) {
  Importing importing(path, {}, {});
  Read read{ref_cast<Scene>(importer_of(path)->import(importing)), {}};
  for (const Error& note : importing.notes()) read.told.emplace_back(note.what());
  return read;
}

TEST(ObjIdioms, OddLinesDoNotRefuseTheFile) {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("odd.obj", square + "vn 1.#QNAN 0 0\nvn 0 0 1\nf 1//1 2//2 3//2\nf 1 2\nf 1//2 3//2 4//2\n");
  testing::internal::CaptureStderr();
  const MeshData mesh = read_mesh(path);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_NE(said.find("line 8: a face of fewer than three vertices"), std::string::npos) << said;
  EXPECT_NE(said.find("line 5: a normal that is no number"), std::string::npos) << said;
  for (const Normal3& n : mesh.normals) EXPECT_TRUE(std::isfinite(n.x));
  EXPECT_EQ(read_mesh(folder.write("more.obj", "v 1e+2 2.e+1 3.1+e2\n" + square + "f 1 2 3\n")).triangles.size(), 1u);
  EXPECT_THROW(read_mesh(folder.write("none.obj", square + "f 1 2\n")), Error);
  EXPECT_THROW(read_mesh(folder.write("bad.obj", square + "vn a 0 0\nf 1 2 3\n")), Error);
}

TEST(ObjIdioms, WhatIsNoTriangleIsTold) {
  const TemporaryFolder folder;
  const Read read = import(folder.write("l.obj", square + "l 1 2\np 3\ncstype bezier\nsurf 0 1 0 1 1 2 3 4\nf 1 2 3 4\n"));
  EXPECT_TRUE(read.has("points and lines are not shown"));
  EXPECT_TRUE(read.has("curves and curved surfaces are not shown"));
}

TEST(ObjIdioms, ColoursOfVertices) {
  const TemporaryFolder folder;
  const std::string behind = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 0.5 0.5 0.5\n";
  const auto check = [&](const std::string& text, const std::string& part_name) {
    SCOPED_TRACE(text);
    const std::string path = folder.write("c" + std::to_string(text.size()) + ".obj", text);
    const MeshData mesh = read_mesh(path, part_name);
    ASSERT_EQ(mesh.attributes.size(), 1u);
    ASSERT_EQ(mesh.attributes[0].values.size(), 3 * mesh.positions.size());
    for (size_t i = 0; i < mesh.positions.size(); ++i)
      if (mesh.positions[i] == Point3{0, 1, 0}) EXPECT_NEAR(mesh.attributes[0].values[3 * i], 0.2140, 2e-3);  // of sRGB 0.5
    const Read read = import(path);
    EXPECT_EQ(gltf_test::class_of(part(*read.scene->objects[0], "shader"), "base_color"), "AttributeMap");
  };
  check(behind + "f 1 2 3 4\n", "");
  check(behind + "vn 0 0 1\nf 1//1 2//1 3//1 4//1\n", "");
  check(behind + "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n", "usemtl b");
  check(square + "#MRGB ffff0000ff00ff00ff0000ffff808080\nf 1 2 3 4\n", "");
  EXPECT_TRUE(read_mesh(folder.write("w.obj", "v 0 0 0 1\nv 1 0 0 1\nv 1 1 0 1\nf 1 2 3\n")).attributes.empty());
}

// An infinite component does not change the scale of the other colours, and neither becomes part of a rendering.
TEST(ObjIdioms, ColoursThatAreNotFiniteAreWhite) {
  const TemporaryFolder folder;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float red\n"
      "property float green\nproperty float blue\nelement face 1\nproperty list uchar int vertex_indices\n";
  const std::string points = "0 0 0 nan 0 0\n1 0 0 0 -inf inf\n0 1 0 0 0 1\n";
  for (const auto& [name, text] :
       {std::pair<const char*, std::string>{"c.obj", "v 0 0 0 nan 0 0\nv 1 0 0 0 -inf inf\nv 0 1 0 0 0 1\nf 1 2 3\n"},
        {"c.off", "COFF\n3 1 0\n" + points + "3 0 1 2\n"},
        {"b.off", "COFF\n3 1 0\n0 0 0 nan 0 0 255\n1 0 0 0 -inf inf 255\n0 1 0 0 0 255 255\n3 0 1 2\n"},
        {"c.ply", ply + "end_header\n" + points + "3 0 1 2\n"}}) {
    testing::internal::CaptureStderr();
    const MeshData mesh = read_mesh(folder.write(name, text));
    const std::string said = testing::internal::GetCapturedStderr(), wanted = "colours that are not finite numbers are white";
    ASSERT_EQ(mesh.attributes.size(), 1u) << name;
    EXPECT_EQ(mesh.attributes[0].values, (std::vector<float>{1, 1, 1, 1, 1, 1, 0, 0, 1})) << name;
    EXPECT_NE(said.find(wanted), std::string::npos) << name;
    EXPECT_EQ(said.find(wanted), said.rfind(wanted)) << name;
  }
  const MeshData faces =
      read_mesh(folder.write("f.ply", ply + "property float red\nproperty float green\nproperty float blue\nend_header\n" +
                                          points + "3 0 1 2 nan 0 0\n"));
  ASSERT_EQ(faces.face_attributes.size(), 1u);
  EXPECT_EQ(faces.face_attributes[0].values, (std::vector<float>{1, 1, 1}));
  EXPECT_EQ(faces.remarks.size(), 1u);
  const MeshData off = read_mesh(folder.write("f.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.5 inf 0\n"));
  ASSERT_EQ(off.face_attributes.size(), 1u);
  EXPECT_EQ(off.face_attributes[0].values, (std::vector<float>{1, 1, 1}));
}

TEST(ObjIdioms, OneMaterialFileThatIsNotThereIsToldOnce) {
  const TemporaryFolder folder;
  EXPECT_EQ(import(folder.write("m.obj", "mtllib My Nice Model.mtl\n" + square + "f 1 2 3\n")).told.size(), 1u);
}

// A card from which an image cuts out a part emits with the remaining part only.
TEST(ObjIdioms, WhatIsCutOutDoesNotShine) {
  const TemporaryFolder folder;
  test::write_image(folder / "holes.png", {1, 1, 1, NumberType::uint8}, {0.4f});
  folder.write("m.mtl", "newmtl m\nKd 0 0 0\nKe 1 1 1\nmap_d -imfchan g holes.png\n");
  const std::string path = folder.write("m.obj", "mtllib m.mtl\n" + square + "vt 0 0\nusemtl m\nf 1/1 2/1 3/1 4/1\n");
  const double y = double(
      test::measure(load_job_text(test::job_text("PathTracer { samples: 16, max_depth: 2 }",
                                                 "OrthographicCamera { from: [0.5, 0.5, 3], to: [0.5, 0.5, 0], width: 0.5 }", 4,
                                                 "Import { file: \"" + path + "\" }"),
                                  "t.etd"))
          .mean.y);
  EXPECT_NEAR(y, 0.4, 0.01);
}

TEST(OffIdioms, FacesHaveColours) {
  const TemporaryFolder folder;
  const std::string points = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  for (const auto& [faces, red] :
       {std::pair{"3 0 1 2 255 0 0\n3 0 2 3 0 128 0 255\n", 1.0}, {"3 0 1 2 0.5 0.0 0.0\n3 0 2 3\n", 0.5}}) {
    const MeshData mesh = read_mesh(folder.write("f.off", points + faces));
    ASSERT_EQ(mesh.face_attributes.size(), 1u);
    ASSERT_EQ(mesh.face_attributes[0].values.size(), 6u);
    EXPECT_NEAR(mesh.face_attributes[0].values[0], red, 1e-3);
    EXPECT_NEAR(mesh.face_attributes[0].values[1], 0, 1e-6);
  }
  EXPECT_TRUE(read_mesh(folder.write("g.off", points + "3 0 1 2\n3 0 2 3\n")).face_attributes.empty());
  const MeshData bytes =
      read_mesh(folder.write("c.off", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 128 0 255\n1 1 0 0 0 0 255\n3 0 1 2\n"));
  EXPECT_NEAR(bytes.attributes[0].values[4], 0.2159, 1e-3);
}

TEST(PlyIdioms, Strips) {
  const TemporaryFolder folder;
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n"
      "property list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n";
  const MeshData mesh = read_mesh(folder.write("s.ply", head + "8 0 1 2 3 -1 1 4 3\n"));
  ASSERT_EQ(mesh.triangles.size(), 3u);
  for (const auto& t : mesh.triangles)  // all have the same front
    EXPECT_GT(cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]).z, 0);
  EXPECT_THROW(read_mesh(folder.write("b.ply", head + "3 0 1 9\n")), Error);
}

TEST(PlyIdioms, TheImageThatItNames) {
  const TemporaryFolder folder;
  test::write_image(folder / "my skin.png", {1, 1, 3, NumberType::uint8}, {0.5f, 0.5f, 0.5f});
  const auto text = [](const std::string& more) {
    return "ply\nformat ascii 1.0\ncomment TextureFile my skin.png\nelement vertex 3\nproperty float x\nproperty float "
           "y\nproperty float z\n" +
           more;
  };
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const Read read = import(folder.write(
      "t.ply", text("property float s\nproperty float t\n" + faces + "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n")));
  EXPECT_TRUE(read.told.empty());
  EXPECT_EQ(gltf_test::class_of(part(*read.scene->objects[0], "shader"), "base_color"), "ImageMap");
  EXPECT_TRUE(import(folder.write("u.ply", text(faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"))).has("no surface coordinates"));
}

}  // namespace
}  // namespace etendue
