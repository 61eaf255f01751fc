// glTF files made here byte by byte, whose contents are known.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "components/importers/gltf/data_uri.h"
#include "components/importers/gltf/pose.h"
#include "components/importers/gltf/primitive.h"
#include "etendue/describe/registry.h"
#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "files/regular_file.h"

namespace etendue {
namespace {

using Json = nlohmann::json;
using namespace std::string_literals;

class GltfTest : public testing::Test {
 protected:
  void SetUp() override {
    static int number = 0;
    folder_ = testing::TempDir() + "gltf_" + std::to_string(::getpid()) + "_" + std::to_string(++number);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << bytes;
    return folder_ + "/" + name;
  }

  static std::string glb(const Json& json, const std::string& binary) {
    std::string text = json.dump(), all = "glTF";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto word = [&](std::uint32_t x) { all.append(reinterpret_cast<const char*>(&x), 4); };
    word(2);
    word(std::uint32_t(12 + 8 + text.size() + 8 + binary.size()));
    word(std::uint32_t(text.size()));
    all += "JSON" + text;
    word(std::uint32_t(binary.size()));
    return all + std::string("BIN\0", 4) + binary;
  }

  template <class T>
  static void put(std::string& to, std::initializer_list<T> values) {
    for (const T value : values) to.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  /// A square of two triangles: positions and normals interleaved, surface coordinates as fractions of 65535.
  static Json square(std::string& binary) {
    for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {2.0f, 0.0f}, {2.0f, 1.0f}, {0.0f, 1.0f}})
      put<float>(binary, {x, y, 0, 0, 0, 1});
    put<std::uint16_t>(binary, {0, 65535, 65535, 65535, 65535, 0, 0, 0});  // v downwards
    put<std::uint8_t>(binary, {0, 1, 2, 0, 2, 3, 0, 0});
    return {
        {"asset", {{"version", "2.0"}}},
        {"buffers", {{{"byteLength", binary.size()}}}},
        {"bufferViews",
         {{{"buffer", 0}, {"byteLength", 96}, {"byteStride", 24}},
          {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 16}},
          {{"buffer", 0}, {"byteOffset", 112}, {"byteLength", 6}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 4}},
          {{"bufferView", 0}, {"byteOffset", 12}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 4}},
          {{"bufferView", 1}, {"componentType", 5123}, {"type", "VEC2"}, {"count", 4}, {"normalized", true}},
          {{"bufferView", 2}, {"componentType", 5121}, {"type", "SCALAR"}, {"count", 6}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"indices", 3}}}}}}},
        {"nodes", {{{"mesh", 0}}}},
        {"scenes", {{{"nodes", {0}}}}},
        {"scene", 0}};
  }

  static std::string error_of(const std::string& path) {
    try {
      Importing importing(path, {});
      importer_of(path)->import(importing);
      return "";
    } catch (const Error& error) {
      EXPECT_STREQ(error.location.file, path.c_str());
      return error.what();
    }
  }

  std::string folder_;
};

TEST_F(GltfTest, InterleavedNormalizedAndSmallIndices) {
  std::string binary;
  const Json json = square(binary);
  const std::string path = write("square.glb", glb(json, binary));
  const MeshData mesh = read_mesh(path, "meshes[0].primitives[0]");
  ASSERT_EQ(mesh.positions.size(), 4u);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.positions[2], Point3(2, 1, 0));
  EXPECT_EQ(mesh.normals[3], Normal3(0, 0, 1));
  EXPECT_EQ(mesh.uvs[0], Point2(0, 0));
  EXPECT_EQ(mesh.uvs[2], Point2(1, 1));
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST_F(GltfTest, SparseElementsReplaceOthers) {
  std::string binary;
  Json json = square(binary);
  const size_t at = binary.size();
  put<std::uint16_t>(binary, {2, 0});
  put<float>(binary, {7, 8, 9});
  json["buffers"][0]["byteLength"] = binary.size();
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", at}, {"byteLength", 2}});
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", at + 4}, {"byteLength", 12}});
  json["accessors"][0]["sparse"] = {
      {"count", 1}, {"indices", {{"bufferView", 3}, {"componentType", 5123}}}, {"values", {{"bufferView", 4}}}};
  const MeshData mesh = read_mesh(write("sparse.glb", glb(json, binary)), "meshes[0].primitives[0]");
  EXPECT_EQ(mesh.positions[2], Point3(7, 8, 9));
  EXPECT_EQ(mesh.positions[3], Point3(0, 1, 0));
}

TEST_F(GltfTest, StripsAndFansKeepTheirOrientation) {
  for (const int mode : {5, 6}) {
    std::string binary;
    Json json = square(binary);
    if (mode == 5) binary[112 + 2] = 3, binary[112 + 3] = 2;  // 0 1 3 2
    if (mode == 6) binary[112 + 2] = 2, binary[112 + 3] = 3;  // 0 1 2 3
    json["accessors"][3]["count"] = 4;
    json["meshes"][0]["primitives"][0]["mode"] = mode;
    const MeshData mesh = read_mesh(write("mode.glb", glb(json, binary)), "meshes[0].primitives[0]");
    ASSERT_EQ(mesh.triangles.size(), 2u);
    double area = 0;
    for (const auto& t : mesh.triangles)
      area += double(cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]).z) / 2;
    EXPECT_NEAR(area, 2, 1e-6) << mode;  // signed: both triangles face +z
  }
}

TEST_F(GltfTest, WhatLiesOutsideIsAnErrorThere) {
  std::string binary;
  const Json good = square(binary);
  const auto broken = [&](const char* pointer, const Json& value) {
    Json json = good;
    json[Json::json_pointer(pointer)] = value;
    return error_of(write("broken.glb", glb(json, binary)));
  };
  EXPECT_NE(broken("/accessors/0/count", 5).find("accessors[0]"), std::string::npos);
  EXPECT_NE(broken("/bufferViews/2/byteLength", 100).find("bufferViews[2]"), std::string::npos);
  EXPECT_NE(broken("/buffers/0/byteLength", 1000).find("buffers[0]"), std::string::npos);
  EXPECT_NE(broken("/nodes/0/mesh", 3).find("meshes[3]"), std::string::npos);
  EXPECT_NE(broken("/nodes/0/children", {0}).find("nodes[0]"), std::string::npos);
  EXPECT_NE(broken("/asset/version", "1.0").find("1.0"), std::string::npos);
  EXPECT_NE(broken("/extensionsRequired", {"EXT_unheard_of"}).find("EXT_unheard_of"), std::string::npos);
  EXPECT_EQ(broken("/asset/generator", "a test"), "");
}

// Compressed data that is not required stands beside uncompressed data, which is read.
TEST_F(GltfTest, WhatIsCompressedIsReadWhereItIsNot) {
  std::string binary;
  Json json = square(binary);
  json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
  const Json meshopt{{"EXT_meshopt_compression", {{"buffer", 0}, {"byteLength", 1}, {"mode", "ATTRIBUTES"}}}};
  json["bufferViews"][0]["extensions"] = meshopt;
  const std::string both = write("both.glb", glb(json, binary));
  EXPECT_EQ(error_of(both), "");
  EXPECT_EQ(read_mesh(both, "meshes[0].primitives[0]").positions[2], Point3(2, 1, 0));

  Json draco = json;
  draco["accessors"][0].erase("bufferView");
  EXPECT_NE(error_of(write("draco.glb", glb(draco, binary))).find("KHR_draco_mesh_compression"), std::string::npos);

  json["buffers"].push_back({{"byteLength", 96}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  json["bufferViews"][0]["buffer"] = 1;
  EXPECT_NE(error_of(write("meshopt.glb", glb(json, binary))).find("EXT_meshopt_compression"), std::string::npos);
}

TEST_F(GltfTest, IndicesBeyondTheVerticesAreAnError) {
  std::string binary;
  const Json json = square(binary);
  binary[112] = 9;
  const std::string path = write("index.glb", glb(json, binary));
  EXPECT_THROW(read_mesh(path, "meshes[0].primitives[0]"), Error);
}

TEST_F(GltfTest, NodesMultiplyDownwardsAndMoveInTime) {
  std::string binary;
  Json json = square(binary);
  const size_t at = binary.size();
  put<float>(binary, {0, 2});                                                // times
  put<float>(binary, {0, 0, 0, 10, 0, 0});                                   // translations
  put<float>(binary, {0, 0, 0, 1, 0, 0, std::sqrt(0.5f), std::sqrt(0.5f)});  // none, then 90 degrees about z
  json["buffers"][0]["byteLength"] = binary.size();
  for (const auto& [offset, length] : {std::pair{at, 8ul}, {at + 8, 24ul}, {at + 32, 32ul}})
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}});
  int view = 3;
  for (const auto& [type, count] : {std::pair{"SCALAR", 2}, {"VEC3", 2}, {"VEC4", 2}})
    json["accessors"].push_back({{"bufferView", view++}, {"componentType", 5126}, {"type", type}, {"count", count}});
  json["nodes"] = {{{"children", {1}}, {"scale", {2, 2, 2}}}, {{"mesh", 0}, {"translation", {0, 1, 0}}}};
  json["animations"] = {{{"samplers", {{{"input", 4}, {"output", 5}}, {{"input", 4}, {"output", 6}}}},
                         {"channels",
                          {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
                           {{"sampler", 1}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}}};
  const auto document = gltf::Document::open(write("moving.glb", glb(json, binary)));
  const auto place = [&](const gltf::Moment& moment) { return gltf::Pose(*document, moment).global(1)(DoublePoint3(1, 0, 0)); };
  EXPECT_EQ(place({}), DoublePoint3(2, 2, 0));  // (1 + 0, 0 + 1) * 2
  const DoublePoint3 half = place({1, 0});      // rotated by 45 degrees, moved by 5
  EXPECT_NEAR(half.x, 2 * (5 + std::sqrt(0.5)), 1e-6);
  EXPECT_NEAR(half.y, 2 * std::sqrt(0.5), 1e-6);
}

TEST_F(GltfTest, SkinsBend) {
  std::string binary;
  Json json = square(binary);
  const size_t at = binary.size();
  put<std::uint8_t>(binary, {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  put<float>(binary, {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  json["buffers"][0]["byteLength"] = binary.size();
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", at}, {"byteLength", 16}});
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", at + 16}, {"byteLength", 64}});
  json["accessors"].push_back({{"bufferView", 3}, {"componentType", 5121}, {"type", "VEC4"}, {"count", 4}});
  json["accessors"].push_back({{"bufferView", 4}, {"componentType", 5126}, {"type", "VEC4"}, {"count", 4}});
  auto& attributes = json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = 4;
  attributes["WEIGHTS_0"] = 5;
  json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}}, {{"name", "rest"}}, {{"translation", {0, 0, 4}}}};
  json["skins"] = {{{"joints", {1, 2}}}};
  json["scenes"] = {{{"nodes", {0, 1, 2}}}};
  const MeshData mesh = read_mesh(write("skin.glb", glb(json, binary)), "nodes[0].primitives[0]");
  EXPECT_EQ(mesh.positions[0], Point3(0, 0, 0));  // the skinned node's own transform has no effect
  EXPECT_EQ(mesh.positions[1], Point3(2, 0, 2));
  EXPECT_EQ(mesh.positions[2], Point3(2, 1, 4));
}

TEST_F(GltfTest, ImagesWithinTheFileAreOpenedByTheirName) {
  std::string binary;
  Json json = square(binary);
  const std::string image = "\x89PNG\r\n\x1a\n and more";
  json["images"] = {{{"bufferView", 3}, {"mimeType", "image/png"}}, {{"uri", "data:image/jpeg;base64,/9j/4AAQ"}}};
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", image.size()}});
  binary += image;
  json["buffers"][0]["byteLength"] = binary.size();
  const std::string path = write("images.glb", glb(json, binary));
  EXPECT_EQ(gltf::Document::open(path)->inner_image(0), "images[0].png");
  EXPECT_EQ(gltf::Document::open(path)->inner_image(1), "images[1].jpg");
  EXPECT_EQ(read_regular_file(path + "#images[0].png"), image);
  EXPECT_EQ(read_regular_file(path + "#images[1].jpg"), "\xff\xd8\xff\xe0\0\x10"s);
  EXPECT_THROW(read_regular_file(path + "#images[2].png"), Error);
}

TEST_F(GltfTest, OneMeshInManyPlacesIsStoredOnce) {
  std::string binary;
  Json json = square(binary);
  json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {3, 0, 0}}}, {{"mesh", 0}, {"translation", {6, 0, 0}}}};
  json["scenes"] = {{{"nodes", {0, 1, 2}}}};
  const std::string path = write("places.glb", glb(json, binary));
  Importing importing(path, {});
  const Ref<Scene> scene = ref_cast<Scene>(importer_of(path)->import(importing));
  ASSERT_EQ(scene->objects.size(), 3u);
  const Value first = get(*scene->objects[0], "scene"), last = get(*scene->objects[2], "scene");
  EXPECT_EQ(*first.as<Ref<Component>>(), *last.as<Ref<Component>>());
}

TEST_F(GltfTest, NamesOfPartsAreRead) {
  for (const char* text : {"meshes[3].primitives[0]", "nodes[7].primitives[1]", "nodes[7].primitives[1] at 0.5 of animation 2",
                           "meshes[0].primitives[0] with TEXCOORD_1"})
    EXPECT_EQ(gltf::PartName::parse(text).text(), text);
  for (const char* text :
       {"", "meshes[3]", "meshes[-1].primitives[0]", "meshes[3].primitives[0] and more", "mesh[3].primitives[0]"})
    EXPECT_THROW(gltf::PartName::parse(text), Error) << text;
}

TEST(DataUri, Decodes) {
  EXPECT_EQ(gltf::decode_data_uri("data:;base64,TQ==").bytes, "M");
  EXPECT_EQ(gltf::decode_data_uri("data:;base64,TWE=").bytes, "Ma");
  EXPECT_EQ(gltf::decode_data_uri("data:;base64,TWFu").bytes, "Man");
  EXPECT_EQ(gltf::decode_data_uri("data:text/plain,a%20b").bytes, "a b");
  EXPECT_THROW(gltf::decode_data_uri("data:;base64,*"), Error);
}

}  // namespace
}  // namespace etendue
