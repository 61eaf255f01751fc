// Dialects of OBJ, MTL and STL: the same keywords with different meanings, depending on the program that wrote them.

#include <algorithm>

#include "components/objects/meshes/mesh_data.h"
#include "etendue/describe/color.h"
#include "gltf_support.h"
#include "render/imported.h"

namespace etendue {
namespace {

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

struct Read {
  std::string text, told;
};
Read import(const std::string& path) {
  Importing importing(path, {}, {});
  const Ref<Component> read = imported(*importer_of(path), importing);
  Read result{write_description(*read), {}};
  for (const Error& note : importing.notes())
    result.told += std::string(note.location.file) + ":" + std::to_string(note.location.line) + ": " + note.what() + "\n";
  return result;
}

/// The opacity of each material, in the order of their names a, b, …; 1 without a mask.
struct Opacities {
  std::vector<double> all;
  std::string told;
};
Opacities opacities(const std::string& head, const std::vector<std::string>& materials) {
  const TemporaryFolder folder;
  std::string mtl = head, obj = "mtllib m.mtl\n" + triangle;
  for (size_t i = 0; i < materials.size(); ++i) {
    const std::string name(1, char('a' + i));
    mtl += "newmtl " + name + "\nKd .5 .5 .5\nillum 2\n" + materials[i];
    obj += "usemtl " + name + "\nf 1 2 3\n";
  }
  folder.write("m.mtl", mtl);
  const std::string path = folder.write("m.obj", obj);
  Importing importing(path, {}, {});
  const Ref<Scene> scene = ref_cast<Scene>(imported(*importer_of(path), importing));
  Opacities found;
  for (const Error& note : importing.notes()) found.told += std::string(note.what()) + "\n";
  for (const Ref<SceneObject>& object : scene->objects) {
    const std::string text = write_description(*object);
    const size_t at = text.find(" opacity: ");
    found.all.push_back(at == std::string::npos ? 1 : std::stod(text.substr(at + 10)));
  }
  return found;
}

TEST(MtlDialects, TransparencyIsReadAsItIsMeant) {
  struct Row {
    const char* head;
    std::vector<std::string> materials;
    std::vector<double> wanted;
    const char* told;
  };
  const char *dialect = "'Tr' is taken for the opacity", *nothing_seen = "it is fully transparent";
  const Row rows[] = {
      {"", {"Tr 0\n"}, {1}, ""},
      {"", {"Tr 0.25\n"}, {0.75}, ""},
      {"", {"d 0.25\n"}, {0.25}, ""},
      {"", {"Tr 0\n", "Tr 1\n"}, {1, 0}, ""},             // something is opaque, and so something may be invisible
      {"", {"Tr 1.000000\n"}, {1}, dialect},              // MeshLab without its header line
      {"", {"Tr 1\n", "Tr 0.25\n"}, {1, 0.25}, dialect},  // by 1 - d nothing would be opaque
      {"# Converted by Meshlab Group\n", {"Tr 0.25\n"}, {0.25}, dialect},
      {"", {"d 1\nTr 1\n", "Tr 0.25\n"}, {1, 0.25}, dialect},  // d determines the meaning of Tr
      {"", {"d 1\nTr 0\n", "Tr 1\n"}, {1, 0}, ""},
      {"", {"d 0.25\nTr 0.75\n"}, {0.25}, ""},
      {"", {"d 0.25\nTr 0.5\n"}, {0.25}, "contradict"},
      {"", {"d 0\nTr 0\n"}, {1}, "it is opaque"},
      {"", {"d 0\n"}, {0}, nothing_seen},
      {"", {"d 0\nTr 1\n", "d 0\n"}, {0, 0}, nothing_seen},
  };
  for (const Row& row : rows) {
    const Opacities found = opacities(row.head, row.materials);
    ASSERT_EQ(found.all.size(), row.wanted.size()) << row.materials[0];
    for (size_t i = 0; i < row.wanted.size(); ++i)
      EXPECT_NEAR(found.all[i], row.wanted[i], 1e-6) << row.head << row.materials[0] << i;
    if (*row.told)
      EXPECT_NE(found.told.find(row.told), std::string::npos) << row.materials[0] << found.told;
    else
      EXPECT_EQ(found.told, "") << row.materials[0];
  }
  // Glass (illum 4) of opacity 0 is visible: no warning.
  EXPECT_EQ(opacities("", {"illum 4\nTr 1\n"}).told, "");
}

// The warning does not depend on the format.
TEST(Transparent, ModelsAreTold) {
  const TemporaryFolder folder;
  const std::string glb = folder.write(
      "t.gltf",
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"materials":[{"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0]}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  EXPECT_NE(import(glb).told.find("it is fully transparent"), std::string::npos);
  const std::string ac =
      "AC3Db\nMATERIAL \"m\" rgb 1 1 1 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 1\nOBJECT world\nkids 1\nOBJECT "
      "poly\nnumvert "
      "3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x20\nmat 0\nrefs 3\n0 0 0\n1 0 0\n2 0 0\nkids 0\n";
  EXPECT_NE(import(folder.write("t.ac", ac)).told.find("it is fully transparent"), std::string::npos);
}

TEST(ObjDialects, IndicesOfListsThatAreNotThere) {
  const TemporaryFolder folder;
  for (const auto& [text, words] : {std::pair{"vn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n", "line 5: its faces name texture coordinates"},
                                    {"vt 0 0\nf 1/1/1 2/1/2 3/1/3\n", "line 5: its faces name normals"},
                                    {"f 1//7 2//7 3//7\n", "line 4: its faces name normals"},
                                    {"f 1/9 2/9 3/9\n", "line 4: its faces name texture coordinates"}}) {
    testing::internal::CaptureStderr();
    const MeshData mesh = read_mesh(folder.write("m.obj", triangle + text));
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_NE(said.find(words), std::string::npos) << said;
  }
  // If the file has texture coordinates, a missing one is an error.
  EXPECT_THROW(read_mesh(folder.write("e.obj", triangle + "vt 0 0\nf 1/1 2/2 3/1\n")), Error);
}

struct Stl {
  std::string head;
  std::vector<std::uint16_t> bits;
  std::string write(const TemporaryFolder& folder) const {
    std::string file = head + std::string(80 - head.size(), ' ');
    const auto count = std::uint32_t(bits.size());
    file.append(reinterpret_cast<const char*>(&count), 4);
    for (size_t i = 0; i < bits.size(); ++i) {
      const float numbers[12] = {0, 0, 1, 0, 0, float(i), 1, 0, float(i), 0, 1, float(i)};
      file.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
      file.append(reinterpret_cast<const char*>(&bits[i]), 2);
    }
    return folder.write("m.stl", file);
  }
};

std::vector<float> colors_of(const MeshData& mesh) {
  for (const VertexAttribute& a : mesh.face_attributes)
    if (a.name == "face_color") return a.values;
  return {};
}

TEST(StlDialects, WhatIsNoColourIsNotTakenForOne) {
  const TemporaryFolder folder;
  std::vector<std::uint16_t> numbers, random;
  std::uint32_t state = 1;
  for (std::uint32_t i = 0; i < 200; ++i) {
    numbers.push_back(std::uint16_t(i));
    random.push_back(std::uint16_t((state = state * 1664525 + 1013904223) >> 16));
  }
  std::vector<std::uint16_t> many(40000);
  for (size_t i = 0; i < many.size(); ++i) many[i] = std::uint16_t(i);
  for (const auto& bits : {std::vector<std::uint16_t>(20, 0x8000), std::vector<std::uint16_t>(20, 0xffff), random, many}) {
    testing::internal::CaptureStderr();
    EXPECT_TRUE(colors_of(read_mesh(Stl{"some program", bits}.write(folder))).empty()) << bits[0];
    EXPECT_NE(testing::internal::GetCapturedStderr().find("not taken for its colour"), std::string::npos) << bits[0];
  }
  for (const auto& bits : {std::vector<std::uint16_t>(20, 0), std::vector<std::uint16_t>(20, 0x2020), numbers}) {
    testing::internal::CaptureStderr();
    EXPECT_TRUE(colors_of(read_mesh(Stl{"some program", bits}.write(folder))).empty()) << bits[0];
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "they claim no colour";
  }
}

TEST(StlDialects, ColoursStay) {
  const TemporaryFolder folder;
  // VisCAM: one colour everywhere; black among other colours; some triangles without a colour.
  const std::vector<float> blue = colors_of(read_mesh(Stl{"", std::vector<std::uint16_t>(20, 0x801f)}.write(folder)));
  ASSERT_EQ(blue.size(), 60u);
  EXPECT_NEAR(blue[0], 0, 1e-6);
  EXPECT_NEAR(blue[2], 1, 1e-6);
  const std::vector<float> mixed = colors_of(read_mesh(Stl{"", {0x8000, 0xfc00, 0}}.write(folder)));
  ASSERT_EQ(mixed.size(), 9u);
  EXPECT_NEAR(mixed[0], 0, 1e-6);
  EXPECT_NEAR(mixed[3], 1, 1e-6);
  EXPECT_NEAR(mixed[6], 0.7, 1e-6);
  EXPECT_EQ(colors_of(read_mesh(Stl{"VisCAM", {0x8000}}.write(folder))).size(), 3u) << "who writes so means black";
  // Magics: the highest bit, or 0 in all triangles, stands for the header's colour; otherwise red is in the lowest bits.
  const std::string head = "COLOR=\xff\x80" + std::string(1, '\0') + "\xff";
  for (const std::uint16_t none : {std::uint16_t(0x8000), std::uint16_t(0xffff), std::uint16_t(0)}) {
    const std::vector<float> all = colors_of(read_mesh(Stl{head, {none, none, none}}.write(folder)));
    ASSERT_EQ(all.size(), 9u);
    EXPECT_NEAR(all[3], 1, 1e-6) << none;
    EXPECT_NEAR(all[4], decode_transfer("srgb", 128.0 / 255), 1e-6) << none;
  }
  const std::vector<float> own = colors_of(read_mesh(Stl{head, {0, 31, 0x8000}}.write(folder)));
  ASSERT_EQ(own.size(), 9u);
  EXPECT_NEAR(own[0], 0, 1e-6);
  EXPECT_NEAR(own[4], 0, 1e-6);
  EXPECT_NEAR(own[3], 1, 1e-6);
}

}  // namespace
}  // namespace etendue
