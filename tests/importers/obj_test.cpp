// OBJ with MTL, STL and OFF: files made here.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "components/objects/meshes/mesh_data.h"
#include "etendue/describe/registry.h"
#include "etendue/importer.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "support/image_file.h"

namespace etendue {
namespace {

class ObjTest : public testing::Test {
 protected:
  void SetUp() override {
    static int number = 0;
    folder_ = testing::TempDir() + "obj_" + std::to_string(::getpid()) + "_" + std::to_string(++number);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << bytes;
    return folder_ + "/" + name;
  }
  static Ref<Scene> import(Importing& importing) { return ref_cast<Scene>(importer_of(importing.path())->import(importing)); }
  static double number(const Component& part, const char* member) {
    const Value value = get(part, member);
    if (const auto* map = value.as<Ref<Component>>()) return number(**map, "value");
    if (const auto* color = value.as<Color>()) return double((*color)->at(550, ColorUse::coefficient));
    return value.as<Number>() ? value.as<Number>()->value : NAN;
  }
  static Ref<Component> part(const Component& of, const char* member) { return *get(of, member).as<Ref<Component>>(); }

  std::string folder_;
};

constexpr const char* two_materials =
    "mtllib colors.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nusemtl shiny\nf 1 2 3 4\nusemtl glass one\nf 1 2 5\n";

TEST_F(ObjTest, EachMaterialIsAMeshOfItsOwn) {
  write("colors.mtl",
        "newmtl shiny\nKd 0.5 0.25 0.125\nKs 0.5 0.5 0.5\nNs 30\nillum 2\n"
        "newmtl glass one\nillum 7\nNi 1.7\nNs 1000\nKs 1 1 1\nTf 0.9 1 1\n");
  Importing importing(write("two.obj", two_materials), {});
  const Ref<Scene> scene = import(importing);
  EXPECT_TRUE(importing.notes().empty());
  ASSERT_EQ(scene->objects.size(), 2u);
  EXPECT_EQ(read_mesh(importing.path(), "usemtl shiny").triangles.size(), 2u);
  EXPECT_EQ(read_mesh(importing.path(), "usemtl shiny").positions.size(), 4u);
  EXPECT_EQ(read_mesh(importing.path(), "usemtl glass one").triangles.size(), 1u);
  EXPECT_THROW(read_mesh(importing.path(), "usemtl brass"), Error);
  const Ref<Component> shiny = part(*scene->objects[0], "shader"), glass = part(*scene->objects[1], "shader");
  EXPECT_NEAR(number(*shiny, "specular_roughness"), 0.5, 1e-6);  // (2 / 32)^(1/4)
  EXPECT_EQ(number(*shiny, "specular_weight"), 1);
  EXPECT_EQ(number(*glass, "transmission_weight"), 1);
  EXPECT_NEAR(number(*glass, "specular_ior"), 1.7, 1e-6);
}

TEST_F(ObjTest, WhatIsMissingIsToldAndNotFatal) {
  write("colors.mtl", "newmtl shiny\nmap_Kd C:\\work\\Missing.png\nrefl sphere.png\n");
  Importing importing(write("two.obj", two_materials), {});
  EXPECT_EQ(import(importing)->objects.size(), 2u);
  std::vector<int> lines;
  for (const Error& note : importing.notes()) lines.push_back(note.location.line);
  EXPECT_EQ(lines, (std::vector<int>{2, 3, 9}));  // the texture, the reflections, the material that no file describes
}

// An image of which only the beginning can be read: the model is read, and the error is reported when the image is opened for
// rendering.
TEST_F(ObjTest, ImagesThatAreCutOff) {
  const std::string image = folder_ + "/bumps.tga";
  std::vector<float> texels;
  for (int i = 0; i < 32 * 32 * 3; ++i) texels.push_back(float(i * i % 251) / 251);
  test::write_image(image, {32, 32, 3, NumberType::uint8}, texels);
  std::filesystem::resize_file(image, std::filesystem::file_size(image) / 2);
  write("colors.mtl", "newmtl shiny\nbump -bm 0.5 bumps.tga\nmap_Kd bumps.tga\nnewmtl glass one\nbump bumps.tga\n");
  Importing importing(write("model.obj", two_materials), {});
  const Ref<Scene> scene = import(importing);
  ASSERT_TRUE(scene);
  EXPECT_EQ(part(*scene->objects[0], "shader")->class_info().name, "BumpShader");
}

TEST_F(ObjTest, ErrorsNameTheLine) {
  Importing importing(write("bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 7\n"), {});
  try {
    import(importing);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.location.line, 3);
    EXPECT_STREQ(error.location.file, importing.path().c_str());
  }
}

// A roof of two slopes, each 45 degrees: within one smoothing group the ridge's normal is vertical, with two groups or none it
// is not.
TEST_F(ObjTest, SmoothingGroupsBlendNormals) {
  const auto roof = [&](const char* first, const char* second) {
    return read_mesh(write("roof.obj", std::string("v -1 0 0\nv 0 1 0\nv 0 1 1\nv -1 0 1\nv 1 0 0\nv 1 0 1\n") + first +
                                           "\nf 4 3 2 1\n" + second + "\nf 3 6 5 2\n"));
  };
  const auto upright = [](const MeshData& mesh) {
    int count = 0;
    for (const Normal3& n : mesh.normals) count += std::abs(n.x) < 1e-5f && n.y > 0;
    return count;
  };
  EXPECT_EQ(upright(roof("s 1", "s 1")), 2);
  EXPECT_EQ(upright(roof("s 1", "s 2")), 0);
  EXPECT_EQ(upright(roof("s off", "s off")), 0);
}

TEST_F(ObjTest, TextInUtf16) {
  const std::string plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::string wide = "\xfe\xff";
  for (const char c : plain) wide += std::string(1, '\0') + c;
  EXPECT_EQ(read_mesh(write("wide.obj", wide)).triangles.size(), 1u);
}

TEST_F(ObjTest, BinaryAndTextStlAreTheSame) {
  std::string binary(80, ' ');
  const std::uint32_t count = 2;
  binary.append(reinterpret_cast<const char*>(&count), 4);
  std::string text = "solid two\n";
  for (const auto& corners : {std::array<float, 9>{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}}) {
    const float normal[3] = {0, 0, 1};
    binary.append(reinterpret_cast<const char*>(normal), 12);
    binary.append(reinterpret_cast<const char*>(corners.data()), 36);
    binary += std::string(2, '\0');
    text += "facet normal 0 0 1\nouter loop\n";
    for (size_t i = 0; i < 9; i += 3)
      text += "vertex " + std::to_string(corners[i]) + " " + std::to_string(corners[i + 1]) + " " +
              std::to_string(corners[i + 2]) + "\n";
    text += "endloop\nendfacet\n";
  }
  const MeshData a = read_mesh(write("a.stl", binary)), b = read_mesh(write("b.stl", text + "endsolid\n"));
  EXPECT_EQ(a.positions.size(), 4u);  // corners at the same position are one vertex
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
  binary.resize(binary.size() - 1);
  EXPECT_THROW(read_mesh(write("short.stl", binary)), Error);
}

TEST_F(ObjTest, OffPolygons) {
  const MeshData mesh = read_mesh(write("square.off", "OFF # a comment\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_THROW(read_mesh(write("bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 3\n")), Error);
}

}  // namespace
}  // namespace etendue
