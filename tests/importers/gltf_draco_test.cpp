// Meshes of glTF files compressed by Draco's own encoder.

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include <algorithm>

#include "components/objects/meshes/mesh_data.h"
#include "glb_support.h"
#include "support/process.h"

namespace etendue {
namespace {

using namespace glb_test;

/// A curved sheet of 2 n^2 triangles with normals, surface coordinates and byte colours, and its bytes as compressed by Draco.
struct Sheet {
  explicit Sheet(int n) {
    const auto place = [&](int x, int y) {
      const float u = float(x) / float(n), v = float(y) / float(n);
      return std::array{u, v, 0.3f * u * u - 0.2f * u * v};
    };
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2 * n * n);
    const int p = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int t = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    const int c = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
    int face = 0;
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (const int half : {0, 1}) {
          using Corners = std::array<std::pair<int, int>, 3>;
          const Corners corners =
              half == 0 ? Corners{{{x, y}, {x + 1, y}, {x, y + 1}}} : Corners{{{x + 1, y}, {x + 1, y + 1}, {x, y + 1}}};
          std::array<std::array<float, 3>, 3> at;
          std::array<std::array<float, 2>, 3> uv;
          std::array<std::array<std::uint8_t, 4>, 3> color;
          for (size_t k = 0; k < 3; ++k) {
            at[k] = place(corners[k].first, corners[k].second);
            uv[k] = {at[k][0], at[k][1]};
            color[k] = {std::uint8_t(255 * corners[k].first / n), std::uint8_t(255 * corners[k].second / n), 51, 255};
          }
          const draco::FaceIndex f(std::uint32_t(face++));
          builder.SetAttributeValuesForFace(p, f, at[0].data(), at[1].data(), at[2].data());
          builder.SetAttributeValuesForFace(t, f, uv[0].data(), uv[1].data(), uv[2].data());
          builder.SetAttributeValuesForFace(c, f, color[0].data(), color[1].data(), color[2].data());
          triangles.push_back(at);
        }
    mesh = builder.Finalize();
    for (int i = 0; i < mesh->num_attributes(); ++i) mesh->attribute(i)->set_unique_id(std::uint32_t(7 + i));
  }
  std::string compressed(int method, int speed) const {
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    encoder.SetSpeedOptions(speed, speed);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) throw std::runtime_error("Draco does not encode");
    return {buffer.data(), buffer.size()};
  }
  std::unique_ptr<draco::Mesh> mesh;
  std::vector<std::array<std::array<float, 3>, 3>> triangles;
};

/// The accessors do not state the numbers of vertices and corners, as in files of some programs: the reader has to take them
/// from Draco's data.
void add_draco(File& file, size_t view) {
  const auto accessor = [&](int component, const char* type, bool normalized) {
    return file.add("accessors", {{"componentType", component}, {"type", type}, {"count", 3}, {"normalized", normalized}});
  };
  Json primitive{{"attributes", {{"POSITION", accessor(5126, "VEC3", false)}, {"TEXCOORD_0", accessor(5126, "VEC2", false)}}},
                 {"indices", accessor(5123, "SCALAR", false)}};
  primitive["attributes"]["COLOR_0"] = accessor(5121, "VEC4", true);
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", 7}, {"TEXCOORD_0", 8}, {"COLOR_0", 9}}}};
  file.json["meshes"][0]["primitives"].push_back(primitive);
  file.json["extensionsRequired"] = file.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
}

TEST(GltfDraco, MeshesByDraco) {
  const TemporaryFolder folder;
  const Sheet sheet(5);
  for (const auto& [method, speed] : {std::pair<int, int>{draco::MESH_EDGEBREAKER_ENCODING, 0},
                                      {draco::MESH_EDGEBREAKER_ENCODING, 10},
                                      {draco::MESH_SEQUENTIAL_ENCODING, 5}}) {
    File file;
    add_draco(file, file.view(sheet.compressed(method, speed)));
    const std::string path = folder.write("sheet.glb", file.text());
    bool refused = false;
    EXPECT_EQ(told(path, refused).find("compress"), std::string::npos);
    EXPECT_FALSE(refused);
    const MeshData mesh = read_mesh(path, "meshes[0].primitives[0]");
    ASSERT_EQ(mesh.triangles.size(), sheet.triangles.size());
    ASSERT_EQ(mesh.positions.size(), 36u);
    // Each triangle is one of the original's, in any order.
    constexpr float tolerance = 1.0f / (1 << 14);
    std::vector<bool> found(sheet.triangles.size());
    for (const auto& t : mesh.triangles)
      for (size_t i = 0; i < found.size(); ++i)
        for (size_t turn = 0; turn < 3; ++turn) {
          float worst = 0;
          for (size_t k = 0; k < 3; ++k) {
            const Point3 p = mesh.positions[t[(k + turn) % 3]];
            for (const float d :
                 {p.x - sheet.triangles[i][k][0], p.y - sheet.triangles[i][k][1], p.z - sheet.triangles[i][k][2]})
              worst = std::max(worst, std::abs(d));
          }
          if (worst < tolerance) found[i] = true;
        }
    EXPECT_EQ(std::ranges::count(found, false), 0) << method << " " << speed;
    ASSERT_EQ(mesh.uvs.size(), 36u);
    ASSERT_EQ(mesh.attributes.at(0).name, "color");
    for (size_t v = 0; v < 36; ++v) {
      EXPECT_NEAR(mesh.uvs[v].x, mesh.positions[v].x, 1e-3);
      EXPECT_NEAR(mesh.uvs[v].y, 1 - mesh.positions[v].y, 1e-3);
      EXPECT_NEAR(mesh.attributes[0].values[3 * v], mesh.positions[v].x, 1e-3);
      EXPECT_NEAR(mesh.attributes[0].values[3 * v + 2], 0.2f, 1e-6);
    }
  }
}

TEST(GltfDraco, PrimitivesShareAMeshOfDraco) {
  const TemporaryFolder folder;
  File file;
  const size_t view = file.view(Sheet(3).compressed(draco::MESH_EDGEBREAKER_ENCODING, 5));
  add_draco(file, view);
  add_draco(file, view);
  file.json["meshes"][0]["primitives"][1]["attributes"].erase("COLOR_0");
  const std::string path = folder.write("shared.glb", file.text());
  const MeshData first = read_mesh(path, "meshes[0].primitives[0]"), second = read_mesh(path, "meshes[0].primitives[1]");
  EXPECT_EQ(first.positions, second.positions);
  EXPECT_EQ(first.triangles, second.triangles);
  EXPECT_EQ(first.attributes.size(), 2u);
  EXPECT_TRUE(second.attributes.empty());
}

TEST(GltfDraco, WrongMeshesOfDracoAreErrorsThere) {
  const TemporaryFolder folder;
  const Sheet sheet(3);
  const std::string right = sheet.compressed(draco::MESH_EDGEBREAKER_ENCODING, 5);
  const auto error = [&](const std::string& compressed, const char* member, const Json& value) {
    File file;
    for (int i = 0; i < 3; ++i) add_draco(file, file.view(right));
    add_draco(file, file.view(compressed));
    add_draco(file, file.view(right));
    if (member)
      file.json["meshes"][0]["primitives"][3]["extensions"]["KHR_draco_mesh_compression"][Json::json_pointer(member)] = value;
    const std::string said = error_of(folder.write("wrong.glb", file.text()));
    EXPECT_TRUE(said.starts_with("meshes[0].primitives[3]: KHR_draco_mesh_compression: ")) << said;
    return said;
  };
  EXPECT_NE(error(right.substr(0, 20), nullptr, {}), "");
  EXPECT_NE(error("no Draco", nullptr, {}).find("Not a Draco file"), std::string::npos);
  EXPECT_NE(error(right, "/attributes/POSITION", 3).find("there is no attribute 3"), std::string::npos);
  EXPECT_NE(error(right, "/attributes/POSITION", 1e12).find("there is no attribute"), std::string::npos);
  EXPECT_NE(error(right, "/bufferView", 99).find("bufferViews[99]"), std::string::npos);
  // Version 2.2, a sequentially encoded mesh of 4 billion triangles and vertices, in a few bytes.
  const std::string claims =
      std::string("DRACO\2\2\1\0\0\0", 11) + "\xff\xff\xff\xff\x0f\xff\xff\xff\xff\x0f" + std::string(40, '\0');
  EXPECT_NE(error(claims, nullptr, {}), "");
}

TEST(GltfDraco, PointsOfDracoAreNoTriangles) {
  const TemporaryFolder folder;
  const Sheet sheet(2);
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  ASSERT_TRUE(encoder.EncodePointCloudToBuffer(*sheet.mesh, &buffer).ok());
  File file;
  add_draco(file, file.view({buffer.data(), buffer.size()}));
  EXPECT_NE(error_of(folder.write("points.glb", file.text())).find("it holds points"), std::string::npos);
}

}  // namespace
}  // namespace etendue
