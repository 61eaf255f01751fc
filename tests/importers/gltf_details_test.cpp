// Details of glTF files, against the words and formulas of the specification and its extensions.

#include "components/objects/meshes/mesh_data.h"
#include "gltf_support.h"

namespace etendue {
namespace {

using namespace gltf_test;

// 3.9.3: scaled normal = normalize((sampled * 2 - 1) * vec3(scale, scale, 1)).
TEST(GltfDetails, NormalsOfNegativeScaleTiltTheOtherWay) {
  const TemporaryFolder folder;
  Square square;
  square.material()["normalTexture"] = {{"index", 0}, {"scale", -1.5}};
  std::string told;
  const Component& shader = square.shader(folder, told);
  EXPECT_EQ(told, "");
  EXPECT_EQ(number(shader, "strength"), -1.5);
}

// A tangent points where u grows; bitangent = cross(normal, tangent.xyz) * tangent.w points against the file's v, which runs
// downwards.
TEST(GltfDetails, TangentsThatCoordinatesDoNotGiveAreTold) {
  const TemporaryFolder folder;
  const auto told = [&](float x, float y, float w, bool mapped) {
    Square square;
    std::vector<float> tangents;
    for (int i = 0; i < 4; ++i) tangents.insert(tangents.end(), {x, y, 0, w});
    square.vertices("TANGENT", tangents, 4);
    if (mapped) square.material()["normalTexture"] = {{"index", 0}};
    std::string notes;
    square.shader(folder, notes);
    return notes;
  };
  EXPECT_EQ(told(1, 0, 1, true), "");
  EXPECT_NE(told(1, 0, -1, true).find("TANGENT vectors lie otherwise"), std::string::npos);
  EXPECT_NE(told(0.7071f, 0.7071f, 1, true).find("TANGENT vectors lie otherwise"), std::string::npos);
  EXPECT_EQ(told(0, 1, 1, false), "") << "nothing follows them";
}

// 3.7.2.2: an attribute is base + sum of weight * target; colours are clamped to [0, 1] afterwards.
TEST(GltfDetails, MorphTargetsMoveColoursAndCoordinates) {
  const TemporaryFolder folder;
  Square square;
  square.vertices("COLOR_0", {.5f, .5f, .5f, 1, .5f, .5f, .5f, 1, .5f, .5f, .5f, 1, .5f, .5f, .5f, 1}, 4);
  const int color = square.floats({.4f, 0, 0, -1, 0, .4f, 0, -1, 0, 0, 4, -1, 0, 0, -4, -1}, 4),
            uv = square.floats({.2f, 0, 0, .2f, 0, 0, 0, 0}, 2);
  square.primitive()["targets"] = {{{"COLOR_0", color}, {"TEXCOORD_0", uv}}};
  square.json()["meshes"][0]["weights"] = {0.5};
  const MeshData mesh = read_mesh(square.write(folder), "nodes[0].primitives[0]");
  ASSERT_EQ(mesh.attributes.size(), 2u);
  const std::vector<float> expected{.7f, .5f, .5f, .5f, .7f, .5f, .5f, .5f, 1, .5f, .5f, 0};
  for (size_t i = 0; i < 12; ++i) EXPECT_NEAR(mesh.attributes[0].values.at(i), expected[i], 1e-6f) << i;
  for (const float alpha : mesh.attributes[1].values) EXPECT_NEAR(alpha, 0.5f, 1e-6f);
  EXPECT_NEAR(mesh.uvs[0].x, 0.1f, 1e-6f);
  EXPECT_NEAR(mesh.uvs[1].y, -0.1f, 1e-6f);  // 1 - (1 + 0.1)
}

// KHR_materials_anisotropy: alpha_b = alpha, alpha_t = mix(alpha, 1, strength^2), alpha = roughness^2. OpenPBR, which
// Principled is: alpha_t = r^2 sqrt(2 / (1 + (1 - a)^2)), alpha_b = (1 - a) alpha_t.
TEST(GltfDetails, AnisotropyStretchesAlongAndKeepsWidth) {
  const TemporaryFolder folder;
  for (const double roughness : {0.2, 0.6})
    for (const double strength : {0.3, 1.0}) {
      Square square;
      square.material()["pbrMetallicRoughness"]["roughnessFactor"] = roughness;
      square.material()["extensions"]["KHR_materials_anisotropy"] = {{"anisotropyStrength", strength}};
      std::string told;
      const Component& shader = square.shader(folder, told);
      EXPECT_EQ(told, "");
      const double r = constant(shader, "specular_roughness"), a = constant(shader, "specular_roughness_anisotropy");
      const double along = r * r * std::sqrt(2 / (1 + (1 - a) * (1 - a))), alpha = roughness * roughness;
      EXPECT_NEAR(along, alpha + (1 - alpha) * strength * strength, 1e-6);
      EXPECT_NEAR((1 - a) * along, alpha, 1e-6);
    }
}

// KHR_materials_pbrSpecularGlossiness: glossiness = factor * alpha of the texture; roughness = 1 - glossiness.
TEST(GltfDetails, GlossinessIsTheFactorTimesTheTexture) {
  const TemporaryFolder folder;
  Square square;
  square.material()["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {{"glossinessFactor", 0.25},
                                                                            {"specularGlossinessTexture", {{"index", 0}}}};
  std::string told;
  const Value to = get(part(square.shader(folder, told), "specular_roughness"), "to");
  ASSERT_TRUE(to.as<Numbers>());
  EXPECT_EQ(to.as<Numbers>()->values, (std::vector<double>{1, 0.75}));
}

// KHR_lights_punctual: the values that exporters write for a spot with a hard edge.
TEST(GltfDetails, SpotsMayHaveHardEdges) {
  const TemporaryFolder folder;
  Square square;
  square.json()["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"intensity", 5}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}}};
  square.json()["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  square.json()["scenes"][0]["nodes"] = {0, 1};
  EXPECT_EQ(square.import(folder).told(), "");
}

// EXT_mesh_gpu_instancing shows one mesh many times; morph weights belong to a node.
TEST(GltfDetails, InstancesWithoutTheirMorphAreTold) {
  const TemporaryFolder folder;
  Square square;
  square.primitive()["targets"] = {{{"POSITION", square.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3)}}};
  const int places = square.floats({0, 0, 0, 5, 0, 0}, 3);
  Json& node = square.json()["nodes"][0];
  node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
  EXPECT_EQ(square.import(folder).told(), "");
  node["weights"] = {0.5};
  EXPECT_NE(square.import(folder).told().find("without what its morph targets add"), std::string::npos);
}

// KHR_node_visibility: nothing below an invisible node is shown, but its cameras are kept.
TEST(GltfDetails, InvisibleNodesAreNotShown) {
  const TemporaryFolder folder;
  Square square;
  square.json()["extensionsRequired"] = {"KHR_node_visibility"};
  square.json()["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  square.json()["nodes"] = {{{"children", {1, 2}}},
                            {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}},
                            {{"camera", 0}},
                            {{"mesh", 0}}};
  square.json()["scenes"][0]["nodes"] = {0, 3};
  const auto shown = [&](bool visible) {
    square.json()["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = visible;
    const mitsuba_test::Imported imported = mitsuba_test::import_file(square.write(folder));
    EXPECT_EQ(imported.told(), "");
    return imported.job ? imported.job->scene->objects.size() : 0;
  };
  EXPECT_EQ(shown(true), 2u);
  EXPECT_EQ(shown(false), 1u);
}

}  // namespace
}  // namespace etendue
