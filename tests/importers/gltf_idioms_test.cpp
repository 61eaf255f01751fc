// Idioms of real glTF files: grey images, emissive cards with holes, glowing eyes, flat nodes.

#include "etendue/object_map.h"
#include "etendue/shader.h"
#include "gltf_support.h"
#include "support/image_file.h"

namespace etendue {
namespace {

using namespace gltf_test;

void write_grey(const TemporaryFolder& folder, const char* name, float value) {
  test::write_image(folder / name, {1, 1, 1, NumberType::uint8}, {value});
}
void write_clear(const TemporaryFolder& folder, const char* name, float alpha) {
  test::write_image(folder / name, {1, 1, 4, NumberType::uint8}, {1, 1, 1, alpha});
}

/// The mean luminance of the middle of the file's square, seen along its normal.
double seen(const std::string& path, const std::string& more = "") {
  return double(test::measure(load_job_text(test::job_text("PathTracer { samples: 64, max_depth: 2 }",
                                                           "OrthographicCamera { from: [1, 1, 3], to: [1, 1, 0], width: 1 }", 4,
                                                           "Import { file: \"" + path + "\" }" + more),
                                            "t.etd"))
                    .mean.y);
}

TEST(GltfIdioms, GreyImagesHaveAllChannels) {
  const TemporaryFolder folder;
  write_grey(folder, "grey.png", 0.6f);
  Square square;
  square.json()["images"][0]["uri"] = "grey.png";
  square.material() = {
      {"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}},
      {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatTexture", {{"index", 0}}}}}}}};
  std::string told;
  const Component& shader = square.shader(folder, told);
  EXPECT_EQ(told.find("channel"), std::string::npos) << told;
  for (const char* member : {"base_metalness", "specular_roughness", "coat_weight"}) {
    const Ref<Component> map = copy(part(shader, member));
    prepare_tree(*map);
    EXPECT_NEAR(dynamic_cast<const ObjectMap&>(*map).scalar(SurfacePoint()), 0.6, 0.01) << member;
  }
}

// Alpha is coverage, also for emission.
TEST(GltfIdioms, WhatIsCutOutDoesNotShine) {
  for (const auto& [mode, alpha, wanted] :
       {std::tuple{"MASK", 0.0f, 0.0}, {"MASK", 1.0f, 1.0}, {"BLEND", 0.6f, 0.6}, {"OPAQUE", 0.0f, 1.0}})
    for (const bool unlit : {false, true}) {
      SCOPED_TRACE(mode + std::to_string(alpha) + (unlit ? " unlit" : ""));
      const TemporaryFolder folder;
      write_clear(folder, "card.png", alpha);
      Square square;
      square.json()["images"][0]["uri"] = "card.png";
      square.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}, {"alphaMode", mode}};
      if (unlit)
        square.material()["extensions"]["KHR_materials_unlit"] = Json::object();
      else
        square.material()["emissiveFactor"] = {1, 1, 1};
      EXPECT_NEAR(seen(square.write(folder)), wanted, 0.01);
    }
}

TEST(GltfIdioms, AConstantAlphaDimsToo) {
  const TemporaryFolder folder;
  Square square;
  square.material() = {
      {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 0.25}}}}, {"alphaMode", "BLEND"}, {"emissiveFactor", {1, 1, 1}}};
  EXPECT_NEAR(seen(square.write(folder)), 0.25, 0.005);
}

std::optional<bool> lit(const Square& square, const TemporaryFolder& folder) {
  Importing importing(square.write(folder), {}, {});
  importer_of(importing.path())->import(importing);
  return importing.is_lit;
}

TEST(GltfIdioms, WhatMerelyGlowsDoesNotStandForLamps) {
  const TemporaryFolder folder;
  write_grey(folder, "black.png", 0);
  const auto glowing = [](double strength, const Json& scale) {
    Square square;
    square.material()["emissiveFactor"] = {1, 1, 1};
    square.material()["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
    // The square at full size with the second material, and a small glowing one, like an eye of a robot.
    square.json()["materials"].push_back({{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
    Json body = square.json()["meshes"][0];
    body["primitives"][0]["material"] = 1;
    square.json()["meshes"].push_back(body);
    square.json()["nodes"].push_back({{"mesh", 1}});
    square.json()["nodes"][0]["scale"] = scale;
    square.json()["scenes"][0]["nodes"] = {0, 1};
    return square;
  };
  EXPECT_EQ(lit(glowing(5, {0.05, 0.05, 1}), folder), false);
  EXPECT_EQ(lit(glowing(500, {0.05, 0.05, 1}), folder), true);
  EXPECT_EQ(lit(glowing(5, {0.5, 0.5, 1}), folder), true);
  Square dark = glowing(5, {1, 1, 1});
  dark.json()["images"][0]["uri"] = "black.png";
  dark.material()["emissiveTexture"] = {{"index", 0}};
  EXPECT_EQ(lit(dark, folder), false);
  dark.material().erase("emissiveTexture");
  dark.material()["emissiveFactor"] = {0, 0, 0};
  EXPECT_EQ(lit(dark, folder), false);
}

TEST(GltfIdioms, RoughSurfacesAreNoMirrors) {
  const TemporaryFolder folder;
  const auto lobes = [&](double roughness, const Json& extensions) {
    Square square;
    square.material()["pbrMetallicRoughness"]["roughnessFactor"] = roughness;
    square.material()["extensions"] = extensions;
    std::string told;
    const Ref<Component> shader = copy(square.shader(folder, told));
    prepare_tree(*shader);
    return dynamic_cast<const Shader&>(*shader).possible_lobes();
  };
  const Json coat = {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}},
             glass = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}};
  EXPECT_FALSE(lobes(0.5, Json::object()) & specular_reflection);
  EXPECT_TRUE(lobes(0, Json::object()) & specular_reflection);
  EXPECT_TRUE(lobes(0.03, Json::object()) & specular_reflection);
  EXPECT_TRUE(lobes(0.5, coat) & specular_reflection);
  EXPECT_FALSE(lobes(0.5, glass) & specular_transmission);
  EXPECT_TRUE(lobes(0, glass) & specular_transmission);
}

// glTF 2.0, 3.5.3: a node with one scale of zero is flat, with three of them it is not shown.
TEST(GltfIdioms, WhatIsFlatIsThere) {
  const TemporaryFolder folder;
  Square square;
  square.json()["nodes"][0]["scale"] = {1, 1, 0};
  EXPECT_EQ(square.import(folder).told(), "");
  ASSERT_EQ(square.objects(), 1u);
  const std::string light = ", Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: 1 } }";
  const double flat = seen(square.write(folder), light);
  square.json()["nodes"][0].erase("scale");
  EXPECT_NEAR(flat / seen(square.write(folder), light), 1, 0.01);
  square.json()["nodes"][0]["scale"] = {1, 0, 0};
  EXPECT_NE(square.import(folder).told().find("scaled to nothing"), std::string::npos);
  EXPECT_EQ(square.objects(), 0u);
}

TEST(GltfIdioms, WhatWasChosenIsNotTold) {
  const TemporaryFolder folder;
  Square square;
  square.json()["scenes"].push_back({{"name", "second"}, {"nodes", {0}}});
  EXPECT_NE(square.import(folder).told().find("of its 2 scenes"), std::string::npos);
  EXPECT_EQ(square.import(folder, {{"scene", "second"}}).told(), "");
}

TEST(GltfIdioms, AllAnimationsAtOnce) {
  const TemporaryFolder folder;
  Square square;
  const int times = square.floats({0, 1, 0, 1}, 2), places = square.floats({0, 0, 0, 3, 0, 0}, 3),
            sizes = square.floats({1, 1, 1, 2, 2, 2}, 3);
  square.json()["accessors"][size_t(times)]["type"] = "SCALAR";
  for (const auto& [path, output] : {std::pair{"translation", places}, {"scale", sizes}})
    square.json()["animations"].push_back({{"samplers", {{{"input", times}, {"output", output}}}},
                                           {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}});
  EXPECT_NE(square.import(folder, {{"time", "1"}}).told().find("of its 2 animations"), std::string::npos);
  EXPECT_EQ(square.import(folder, {{"time", "1"}, {"animation", "all"}}).told(), "");
  const Ref<Component> object = copy(square.object());
  prepare_tree(*object);
  const Bounds3 box = dynamic_cast<const SceneObject&>(*object).bounds();
  EXPECT_NEAR(box.low.x, 3, 1e-5);
  EXPECT_NEAR(box.high.x, 7, 1e-5);
}

TEST(GltfIdioms, WhatIsNotSeenIsNotTold) {
  const TemporaryFolder folder;
  Square square;
  square.json()["extensionsUsed"] = {"KHR_xmp_json_ld", "KHR_node_selectability", "XYZ_materials_odd"};
  square.material()["extensions"]["XYZ_materials_odd"] = Json::object();
  const std::string told = square.import(folder).told();
  EXPECT_EQ(std::ranges::count(told, '\n'), 1) << told;
  EXPECT_NE(told.find("XYZ_materials_odd"), std::string::npos) << told;
}

TEST(GltfIdioms, PrimitivesWithoutPlacesAreLeftOut) {
  const TemporaryFolder folder;
  Square square;
  square.json()["meshes"][0]["primitives"].push_back({{"attributes", Json::object()}});
  EXPECT_NE(square.import(folder).told().find("without POSITION"), std::string::npos);
  EXPECT_EQ(square.objects(), 1u);
}

}  // namespace
}  // namespace etendue
