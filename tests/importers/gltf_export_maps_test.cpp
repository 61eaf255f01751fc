// Images of numbers and of normals, vertex colours, and lamps of other shapes, exported to glTF and read back.

#include "components/objects/meshes/mesh_data.h"
#include "components/scenes/import.h"
#include "etendue/exporter.h"
#include "files/regular_file.h"
#include "gltf_support.h"
#include "support/image_file.h"

namespace etendue {
namespace {

using namespace gltf_test;

struct Exported {
  Json json;
  std::string told;
};

/// A job of some objects exported to glTF; the file is out.gltf in the folder.
Exported exported(const TemporaryFolder& folder, const std::string& objects) {
  Exported result;
  const Ref<Job> job = load_job_text(
      test::job_text("PathTracer { samples: 4 }", "PerspectiveCamera { from: [0, 0, 6], to: [0, 0, 0] }", 4, objects), "t.etd",
      folder.path());
  Exporting exporting(folder / "out.gltf");
  const std::string text = exporter_of("out.gltf")->write(*job, exporting);
  folder.write("out.gltf", text);
  exporting.write_files();
  for (const Error& note : exporting.notes()) result.told += note.what() + std::string("\n");
  result.json = Json::parse(text);
  return result;
}
/// The description of the exported file after it is imported again.
std::string back(const TemporaryFolder& folder) {
  const mitsuba_test::Imported read = mitsuba_test::import_file(folder / "out.gltf");
  return read.job ? write_description(*read.job) : read.told();
}

void write_rgba(const TemporaryFolder& folder, const char* name) {
  test::write_image(folder / name, {1, 1, 4, NumberType::uint8}, {0.2f, 0.4f, 0.6f, 0.8f});
}

TEST(GltfExportMaps, ImagesOfNormals) {
  const TemporaryFolder folder;
  write_rgba(folder, "n.png");
  const Exported plain = exported(
      folder, "Box { shader: NormalMapShader { file: \"n.png\", strength: 0.5, repeat: [2, 3], shader: Lambertian {} } }");
  const Json& texture = plain.json["materials"][0]["normalTexture"];
  EXPECT_EQ(texture["scale"], 0.5);
  EXPECT_EQ(texture["extensions"]["KHR_texture_transform"]["scale"], Json({2.0, 3.0}));
  EXPECT_EQ(plain.told.find("sRGB"), std::string::npos) << plain.told;
  const Exported mapped = exported(folder,
                                   "Box { shader: NormalMapShader { map: UvTransformMap { shift: [0.25, 0.5], map: ImageMap { "
                                   "file: \"n.png\", transfer: \"linear\", wrap: clamp } }, "
                                   "shader: Lambertian {} } }");
  EXPECT_TRUE(mapped.json["materials"][0].contains("normalTexture")) << mapped.told;
  EXPECT_EQ(mapped.json["samplers"][0]["wrapS"], 33071);
  EXPECT_NE(back(folder).find("NormalMapShader"), std::string::npos);
}

TEST(GltfExportMaps, MetalAndRoughnessOfOneImage) {
  const TemporaryFolder folder;
  write_rgba(folder, "mr.png");
  const auto channel = [](const char* name) {
    return std::string("ImageMap { file: \"mr.png\", transfer: \"linear\", channel: \"") + name + "\" }";
  };
  const Exported both =
      exported(folder, "Box { shader: Principled { base_metalness: " + channel("B") +
                           ", specular_roughness: MultiplyMap { first: " + channel("G") + ", second: 0.5 } } }");
  const Json& metal = both.json["materials"][0]["pbrMetallicRoughness"];
  EXPECT_TRUE(metal.contains("metallicRoughnessTexture")) << both.told;
  EXPECT_EQ(metal["metallicFactor"], 1.0);
  EXPECT_EQ(metal["roughnessFactor"], 0.5);
  EXPECT_EQ(both.told.find("differs from place to place"), std::string::npos) << both.told;
  const Exported red = exported(folder, "Box { shader: Principled { specular_roughness: " + channel("R") + " } }");
  EXPECT_FALSE(red.json["materials"][0]["pbrMetallicRoughness"].contains("metallicRoughnessTexture"));
  EXPECT_NE(red.told.find("differs from place to place"), std::string::npos) << red.told;
  const Exported coat = exported(folder, "Box { shader: Principled { coat_weight: " + channel("R") + " } }");
  EXPECT_TRUE(coat.json["materials"][0]["extensions"]["KHR_materials_clearcoat"].contains("clearcoatTexture")) << coat.told;
}

TEST(GltfExportMaps, ColoursOfVertices) {
  const TemporaryFolder folder;
  const std::string mesh = "TriangleMesh { positions: [0, 0, 0, 1, 0, 0, 0, 1, 0] m, triangles: [0, 1, 2], ";
  const Exported made = exported(
      folder, mesh +
                  "colors: [1, 0, 0, 0, 1, 0, 0, 0, 0.5], shader: Lambertian { color: AttributeMap { name: \"color\" } } }, " +
                  mesh + "shader: Lambertian {} }");
  ASSERT_TRUE(made.json["meshes"][0]["primitives"][0]["attributes"].contains("COLOR_0")) << made.told;
  EXPECT_FALSE(made.json["meshes"][1]["primitives"][0]["attributes"].contains("COLOR_0"));
  EXPECT_EQ(made.told.find("AttributeMap"), std::string::npos) << made.told;
  const MeshData read = read_mesh(folder / "out.gltf", "meshes[0].primitives[0]");
  ASSERT_EQ(read.attributes.size(), 1u);
  EXPECT_EQ(read.attributes[0].values, (std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 0.5f}));
}

// The holes of an emissive card (alpha mask) survive import and export.
TEST(GltfExportMaps, CardsWithHoles) {
  const TemporaryFolder folder;
  write_rgba(folder, "card.png");
  Square square;
  square.json()["images"][0]["uri"] = "card.png";
  square.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                       {"alphaMode", "MASK"},
                       {"alphaCutoff", 0.25},
                       {"emissiveFactor", {1, 1, 1}},
                       {"emissiveTexture", {{"index", 0}}}};
  square.write(folder);
  const Ref<Job> job =
      load_job_text(test::job_text("PathTracer { samples: 4 }", "PerspectiveCamera { from: [0, 0, 6], to: [0, 0, 0] }", 4,
                                   "Import { file: \"s.gltf\" }"),
                    "t.etd", folder.path());
  read_imports(*job);
  Exporting exporting(folder / "out.gltf");
  const Json json = Json::parse(exporter_of("out.gltf")->write(*job, exporting));
  const Json& m = json["materials"][0];
  EXPECT_EQ(m["alphaMode"], "MASK");
  EXPECT_NEAR(m["alphaCutoff"].get<double>(), 0.25, 1e-6);
  EXPECT_TRUE(m.contains("emissiveTexture")) << m;
  EXPECT_EQ(m["emissiveFactor"], Json({1.0, 1.0, 1.0}));
  EXPECT_NEAR(m["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"].get<double>(), 1, 1e-6);
}

// A lamp of a shape that glTF cannot express keeps its power.
TEST(GltfExportMaps, LampsOfOtherShapes) {
  const TemporaryFolder folder;
  folder.write("lamp.ies",
               "IESNA91\nTILT=NONE\n1 -1 100 3 1 1 2 0 0 0\n1 1 10\n0 90 180\n0\n1 1 1\n");  // 100 cd everywhere
  const Exported made =
      exported(folder,
               "Point { emission: IesEmission { file: \"lamp.ies\" } }, Point { emission: ProjectorEmission { picture: "
               "ConstantMap { value: 1 }, fov: 60 deg } }");
  const Json& lights = made.json["extensions"]["KHR_lights_punctual"]["lights"];
  ASSERT_EQ(lights.size(), 2u) << made.told;
  EXPECT_EQ(lights[0]["type"], "point");
  // From watts: 683.002 lumens for each, at the wavelength where the eye is most sensitive.
  const double even = lights[0]["intensity"].get<double>();
  EXPECT_GT(even, 0);
  EXPECT_NE(made.told.find("IesEmission shines alike in all directions"), std::string::npos) << made.told;
  const Exported surface = exported(folder, "Disc { emission: IesEmission { file: \"lamp.ies\" } }");
  EXPECT_TRUE(surface.json["materials"][0].contains("emissiveFactor")) << surface.told;
}

}  // namespace
}  // namespace etendue
