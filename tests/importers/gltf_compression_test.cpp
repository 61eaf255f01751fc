// Compressed buffer views of glTF files, in the simplest encoding that meshopt's codec allows, and quantized numbers.

#include <tuple>

#include "components/objects/meshes/mesh_data.h"
#include "glb_support.h"
#include "support/process.h"

namespace etendue {
namespace {

using namespace glb_test;

// ---- EXT_meshopt_compression, KHR_meshopt_compression ------------------------------------------------------------------

/// Version 0 of the codec with all differences as whole bytes; at most 256 elements.
std::string compressed_vertices(const std::string& bytes, size_t stride) {
  std::string all = "\xa0";
  const size_t count = bytes.size() / stride, groups = (count + 15) / 16;
  for (size_t k = 0; k < stride; ++k) {
    all.append((groups + 3) / 4, '\xff');
    for (size_t i = 0; i < 16 * groups; ++i) {
      const auto at = [&](size_t element) { return int(std::uint8_t(bytes[element * stride + k])); };
      const auto difference = i == 0 || i >= count ? std::int8_t(0) : std::int8_t(at(i) - at(i - 1));
      all.push_back(char(difference < 0 ? -2 * difference - 1 : 2 * difference));
    }
  }
  return all + std::string(stride < 32 ? 32 - stride : 0, '\0') + bytes.substr(0, stride);
}

/// Each index is encoded by its difference from the one before.
std::string compressed_indices(const std::vector<int>& indices) {
  std::string all = "\xd1";
  int last = 0;
  for (const int index : indices) {
    const int difference = index - last, code = (difference < 0 ? -2 * difference - 1 : 2 * difference) * 2;
    all.push_back(char(code));
    last = index;
  }
  return all + std::string(4, '\0');
}

/// A square of two triangles whose buffer views are compressed; buffer 1 is the fallback buffer, which would hold them
/// uncompressed.
File meshopt_square(const std::string& extension) {
  File file;
  file.json["extensionsRequired"] = file.json["extensionsUsed"] = {extension, "KHR_mesh_quantization"};
  file.json["buffers"] = {Json::object(), {{"byteLength", 1000}}};
  const auto view = [&](const std::string& compressed, size_t count, size_t stride, const char* mode, const char* filter) {
    const Json by{{"buffer", 0},
                  {"byteOffset", file.put(compressed)},
                  {"byteLength", compressed.size()},
                  {"count", count},
                  {"byteStride", stride},
                  {"mode", mode},
                  {"filter", filter}};
    Json all{{"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{extension, by}}}};
    if (stride != 2) all["byteStride"] = stride;
    return file.add("bufferViews", all);
  };
  const auto accessor = [&](size_t view, int component, const char* type, size_t count, bool normalized) {
    return file.add(
        "accessors",
        {{"bufferView", view}, {"componentType", component}, {"type", type}, {"count", count}, {"normalized", normalized}});
  };
  // Positions as fractions of 32767, three numbers and padding; normals in octahedral encoding, of 8 bits.
  const std::vector<std::int16_t> places{0, 0, 0, 0, 32767, 0, 0, 0, 32767, 32767, 0, 0, 0, 32767, 0, 0};
  const std::vector<std::int8_t> normals{0, 0, 127, 0, 0, 0, 127, 0, 127, 0, 127, 0, 0, 0, 127, 0};
  Json& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["POSITION"] =
      accessor(view(compressed_vertices(bytes_of(places), 8), 4, 8, "ATTRIBUTES", "NONE"), 5122, "VEC3", 4, true);
  primitive["attributes"]["NORMAL"] =
      accessor(view(compressed_vertices(bytes_of(normals), 4), 4, 4, "ATTRIBUTES", "OCTAHEDRAL"), 5120, "VEC3", 4, true);
  primitive["indices"] =
      accessor(view(compressed_indices({0, 1, 2, 0, 2, 3}), 6, 2, "INDICES", "NONE"), 5123, "SCALAR", 6, false);
  return file;
}

TEST(GltfCompression, ViewsByMeshopt) {
  const TemporaryFolder folder;
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const std::string path = folder.write("square.glb", meshopt_square(extension).text());
    bool refused = false;
    EXPECT_EQ(told(path, refused), "");
    const MeshData mesh = read_mesh(path, "meshes[0].primitives[0]");
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[2], Point3(1, 1, 0));
    EXPECT_EQ(mesh.normals[0], Normal3(0, 0, 1));
    EXPECT_EQ(mesh.normals[2], Normal3(1, 0, 0));
    EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
  }
}

TEST(GltfCompression, WhatStandsBesideAMeshoptViewIsReadWhereItIsThere) {
  const TemporaryFolder folder;
  File file = meshopt_square("EXT_meshopt_compression");
  file.json.erase("extensionsRequired");
  file.json["buffers"][1]["extensions"]["EXT_meshopt_compression"]["fallback"] = true;
  file.json["buffers"][1]["uri"] = "beside.bin";
  const std::string path = folder.write("square.glb", file.text());
  EXPECT_EQ(read_mesh(path, "meshes[0].primitives[0]").positions[2], Point3(1, 1, 0));  // the fallback file does not exist
  file.json["buffers"][1].erase("extensions");
  EXPECT_NE(error_of(folder.write("needed.glb", file.text())).find("beside.bin"), std::string::npos);
  // Without the `fallback` mark the buffer is read like any other: it holds zeros, so that both triangles use vertex 0 only.
  folder.write("beside.bin", std::string(1000, '\0'));
  EXPECT_EQ(read_mesh(folder.write("beside.glb", file.text()), "meshes[0].primitives[0]").positions.size(), 1u);
}

TEST(GltfCompression, WrongMeshoptViewsAreErrorsThere) {
  const TemporaryFolder folder;
  const std::string name = "EXT_meshopt_compression";
  const auto broken = [&](const char* member, const Json& value) {
    File file = meshopt_square(name);
    file.json["bufferViews"][1]["extensions"][name][member] = value;
    return error_of(folder.write("broken.glb", file.text()));
  };
  for (const auto& [member, value, words] : {std::tuple{"mode", Json("VERTICES"), "'mode' 'VERTICES' is unknown"},
                                             {"filter", Json("GAUSS"), "'filter' 'GAUSS' is unknown"},
                                             {"filter", Json("QUATERNION"), "QUATERNION needs a 'byteStride' of 8, not 4"},
                                             {"count", Json(5), "5 elements of 4 bytes are not the 16 bytes of the view"},
                                             {"byteStride", Json(0), "4 elements of 0 bytes"},
                                             {"byteLength", Json(100000), "it reaches to byte"},
                                             {"byteLength", Json(20), "20 compressed bytes cannot hold its 4 elements"},
                                             {"buffer", Json(1), "buffers[1] has no 'uri'"},
                                             {"buffer", Json(7), "there is no buffers[7]"},
                                             {"mode", Json("TRIANGLES"), "a 'filter' is for the mode ATTRIBUTES alone"}}) {
    const std::string error = broken(member, value);
    EXPECT_NE(error.find(words), std::string::npos) << error;
    EXPECT_TRUE(error.starts_with("bufferViews[1]: EXT_meshopt_compression: ")) << error;
  }
  // Compressed bytes that several views share could expand to any number of bytes.
  File file = meshopt_square(name);
  std::string zeros = "\xa1";  // version 1 stores 256 equal elements of 32 bytes in 8 bytes
  for (int block = 0; block < 40; ++block) zeros += std::string(8, '\xaa');
  zeros += std::string(40, '\0');
  const Json by{{"buffer", 0},      {"byteOffset", file.put(zeros)}, {"byteLength", zeros.size()}, {"count", 256 * 40},
                {"byteStride", 32}, {"mode", "ATTRIBUTES"}};
  for (int i = 0; i < 5; ++i)
    file.add("bufferViews", {{"buffer", 1}, {"byteLength", 256 * 40 * 32}, {"extensions", {{name, by}}}});
  const std::string error = error_of(folder.write("same.glb", file.text()));
  EXPECT_NE(error.find("the compressed bytes of several views are the same"), std::string::npos) << error;
}

// ---- KHR_mesh_quantization -------------------------------------------------------------------------------------------------

TEST(GltfCompression, QuantizedAttributes) {
  const TemporaryFolder folder;
  File file;
  file.json["extensionsRequired"] = file.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  const auto accessor = [&](const std::string& bytes, size_t stride, int component, const char* type, bool normalized) {
    const size_t view = file.view(bytes);
    file.json["bufferViews"][view]["byteStride"] = stride;
    return file.add(
        "accessors",
        {{"bufferView", view}, {"componentType", component}, {"type", type}, {"count", 3}, {"normalized", normalized}});
  };
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["POSITION"] =
      accessor(bytes_of(std::vector<std::uint16_t>{0, 0, 0, 0, 300, 0, 0, 0, 0, 65535, 7, 0}), 8, 5123, "VEC3", false);
  attributes["NORMAL"] =
      accessor(bytes_of(std::vector<std::int8_t>{0, 0, 127, 0, 0, -127, 0, 0, -128, 0, 0, 0}), 4, 5120, "VEC3", true);
  attributes["TEXCOORD_0"] =
      accessor(bytes_of(std::vector<std::int16_t>{0, 0, -32767, 32767, 16384, 0}), 4, 5122, "VEC2", true);
  const std::string path = folder.write("quantized.glb", file.text());
  bool refused = false;
  EXPECT_EQ(told(path, refused), "");
  const MeshData mesh = read_mesh(path, "meshes[0].primitives[0]");
  EXPECT_EQ(mesh.positions, (std::vector<Point3>{{0, 0, 0}, {300, 0, 0}, {0, 65535, 7}}));
  EXPECT_EQ(mesh.normals, (std::vector<Normal3>{{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}}));
  EXPECT_EQ(mesh.uvs[1], Point2(-1, 0));
  EXPECT_NEAR(mesh.uvs[2].x, 0.5, 1e-4);
}

}  // namespace
}  // namespace etendue
