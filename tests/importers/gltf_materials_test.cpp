// Materials of glTF against the formulas of its specification (appendix B) and of the KHR_materials extensions.

#include "gltf_support.h"

namespace etendue {
namespace {

using namespace gltf_test;

/// A picture of one white pixel with an alpha of 128/255.
constexpr const char* half_clear_white =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAA"
    "DUlEQVR42mP4//9/AwAJfAN+keUJTQAAAABJRU5ErkJggg==";

Json& extended(Square& square, const char* name) { return square.material()["extensions"][name]; }

// KHR_materials_sheen: alpha_g = roughness^2, f = colour D V + (1 - max(colour) E) f_base.
TEST(GltfMaterials, SheenHidesAsMuchAsItsColourSays) {
  const TemporaryFolder folder;
  Square square;
  extended(square, "KHR_materials_sheen") = {{"sheenColorFactor", {0.1, 0.2, 0.05}}, {"sheenRoughnessFactor", 0.6}};
  std::string told;
  const Component& shader = square.shader(folder, told);
  EXPECT_EQ(told, "");
  EXPECT_NEAR(constant(shader, "fuzz_roughness"), 0.36, 1e-6);
  EXPECT_NEAR(constant(shader, "fuzz_weight"), 0.2, 1e-6);
  const std::array<double, 3> rgb = color(shader, "fuzz_color");
  EXPECT_NEAR(rgb[0], 0.5, 2e-3);
  EXPECT_NEAR(rgb[1], 1, 2e-3);
  EXPECT_NEAR(rgb[2], 0.25, 2e-3);
}

TEST(GltfMaterials, SheenRoughnessIsSquaredInImagesToo) {
  const TemporaryFolder folder;
  Square square;
  square.json()["images"][0]["uri"] = half_clear_white;
  extended(square, "KHR_materials_sheen") = {
      {"sheenColorFactor", {1, 1, 1}}, {"sheenRoughnessFactor", 0.6}, {"sheenRoughnessTexture", {{"index", 0}}}};
  std::string told;
  const Component& shader = square.shader(folder, told);
  EXPECT_EQ(class_of(shader, "fuzz_roughness"), "PowerMap");
  EXPECT_EQ(constant(part(shader, "fuzz_roughness"), "exponent"), 2);
}

// Sheen fibres have an alpha of at least 0.1 here.
TEST(GltfMaterials, SheenSharperThanThereIsIsTold) {
  const TemporaryFolder folder;
  Square square;
  extended(square, "KHR_materials_sheen") = {{"sheenColorFactor", {1, 1, 1}}};
  EXPECT_NE(square.import(folder).told().find("a roughness of fibres below 0.32 becomes"), std::string::npos);
}

// KHR_materials_specular: "The metal BRDF is not affected by the parameter."
TEST(GltfMaterials, SpecularIsNotOfMetal) {
  const TemporaryFolder folder;
  Square square;
  std::string told;
  extended(square, "KHR_materials_specular") = {{"specularFactor", 0.25}, {"specularColorFactor", {1, 0, 0}}};
  square.material()["pbrMetallicRoughness"]["metallicFactor"] = 1;
  const Component& metal = square.shader(folder, told);
  EXPECT_EQ(told, "");
  EXPECT_EQ(constant(metal, "specular_weight"), 1);
  EXPECT_EQ(constant(metal, "specular_color"), 1);

  // With an image of metalness: F90 = mix(specular, 1, metallic).
  extended(square, "KHR_materials_specular") = {{"specularFactor", 0.25}};
  square.material()["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
  const Component& mixed = part(square.shader(folder, told), "specular_weight");
  EXPECT_EQ(told, "");
  ASSERT_EQ(mixed.class_info().name, "RemapMap");
  EXPECT_EQ(get(mixed, "to").as<Numbers>()->values, (std::vector<double>{0.25, 1}));
  EXPECT_EQ(*get(part(mixed, "input"), "channel").as<std::string>(), "B");

  square.material()["pbrMetallicRoughness"] = {{"metallicFactor", 0.5}};
  EXPECT_NEAR(constant(square.shader(folder, told), "specular_weight"), 0.625, 1e-6);
  EXPECT_NE(told.find("mixture of metal"), std::string::npos);
}

// KHR_materials_iridescence: mix(minimum, maximum, texture.g) [nm]; the maximum where there is no texture.
TEST(GltfMaterials, FilmsAreBetweenTheirThicknesses) {
  const TemporaryFolder folder;
  Square square;
  std::string told;
  extended(square, "KHR_materials_iridescence") = {{"iridescenceFactor", 1}, {"iridescenceThicknessMinimum", 150}};
  EXPECT_EQ(constant(square.shader(folder, told), "thin_film_thickness"), 400);
  extended(square, "KHR_materials_iridescence")["iridescenceThicknessTexture"] = {{"index", 0}};
  const Component& thickness = part(square.shader(folder, told), "thin_film_thickness");
  EXPECT_EQ(told, "");
  ASSERT_EQ(thickness.class_info().name, "RemapMap");
  EXPECT_EQ(get(thickness, "to").as<Numbers>()->values, (std::vector<double>{150, 400}));
  EXPECT_EQ(*get(part(thickness, "input"), "channel").as<std::string>(), "G");
}

// KHR_materials_diffuse_transmission: mix(diffuse_brdf(baseColor), diffuse_btdf(diffuseTransmissionColor), factor).
TEST(GltfMaterials, LeavesLetLightThrough) {
  const TemporaryFolder folder;
  Square square;
  std::string told;
  square.json()["extensionsRequired"] = {"KHR_materials_diffuse_transmission"};
  extended(square, "KHR_materials_diffuse_transmission") = {{"diffuseTransmissionFactor", 0.4},
                                                            {"diffuseTransmissionColorFactor", {0.25, 0.25, 0.25}}};
  const Component& leaf = square.shader(folder, told);
  EXPECT_EQ(told, "");
  EXPECT_EQ(constant(leaf, "subsurface_weight"), 0.4f);
  EXPECT_NEAR(constant(leaf, "subsurface_color"), 0.25, 1e-6);
  EXPECT_EQ(number(leaf, "subsurface_scatter_anisotropy"), 1);
  EXPECT_TRUE(*get(leaf, "thin_walled").as<bool>());
  extended(square, "KHR_materials_transmission") = {{"transmissionFactor", 0.5}};
  extended(square, "KHR_materials_volume") = {{"thicknessFactor", 1}};
  EXPECT_NE(square.import(folder).told().find("lets no light through"), std::string::npos);
}

// Vertex colours tint the transmitted light like the reflected light: baseColor is their product.
TEST(GltfMaterials, VerticesTintWhatGoesThrough) {
  const TemporaryFolder folder;
  Square square;
  std::string told;
  square.vertices("COLOR_0", {1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, 3);
  extended(square, "KHR_materials_transmission") = {{"transmissionFactor", 1}};
  EXPECT_EQ(class_of(square.shader(folder, told), "transmission_color"), "AttributeMap");
}

// KHR_materials_ior: 0 stands for an F0 of 1, so that specularColorFactor is F0 itself: how files with
// KHR_materials_pbrSpecularGlossiness are converted, some with an ior of 1000 instead.
TEST(GltfMaterials, InfiniteIndicesLeaveTheReflectanceToItsColour) {
  const TemporaryFolder folder;
  for (const double ior : {0.0, 1000.0}) {
    Square square;
    std::string told;
    extended(square, "KHR_materials_ior")["ior"] = ior;
    extended(square, "KHR_materials_specular")["specularColorFactor"] = {0.04, 0.04, 0.02};
    const Component& plastic = square.shader(folder, told);
    EXPECT_NE(told.find("as coloured at grazing angles"), std::string::npos);
    EXPECT_NEAR(number(plastic, "specular_ior"), 1.5, 2e-3) << ior;
    EXPECT_NEAR(color(plastic, "specular_color")[2], 0.5, 2e-3);
    EXPECT_NEAR(color(plastic, "specular_color")[0], 1, 2e-3);

    square.material()["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, 1};
    extended(square, "KHR_materials_specular")["specularColorFactor"] = {0.9, 0.6, 0.3};
    const Component& gold = square.shader(folder, told);
    EXPECT_EQ(told, "");
    EXPECT_EQ(constant(gold, "base_metalness"), 1);
    EXPECT_NEAR(color(gold, "base_color")[1], 0.6, 3e-3);
    EXPECT_EQ(constant(gold, "specular_color"), 1);
  }
}

// KHR_materials_specular: F0 = F0(ior) specularColor, F90 = 1.
TEST(GltfMaterials, GreySpecularColoursAreIndices) {
  const TemporaryFolder folder;
  for (const double grey : {0.25, 2.0}) {
    Square square;
    std::string told;
    extended(square, "KHR_materials_specular")["specularColorFactor"] = {grey, grey, grey};
    const Component& shader = square.shader(folder, told);
    EXPECT_EQ(told, "");
    const double n = number(shader, "specular_ior");
    EXPECT_NEAR(std::pow((n - 1) / (n + 1), 2), 0.04 * grey, 1e-6);
    EXPECT_NEAR(color(shader, "specular_color")[1], 1, 1e-3);
  }
}

// KHR_materials_specular: the direction of refracted light is that of KHR_materials_ior alone.
TEST(GltfMaterials, RefractionByAnotherIndexIsTold) {
  const TemporaryFolder folder;
  Square square;
  extended(square, "KHR_materials_transmission")["transmissionFactor"] = 1;
  extended(square, "KHR_materials_volume")["thicknessFactor"] = 1;
  EXPECT_EQ(square.import(folder).told(), "");
  extended(square, "KHR_materials_specular")["specularColorFactor"] = {2, 2, 2};
  EXPECT_NE(square.import(folder).told().find("refracted by the index"), std::string::npos);
}

// KHR_materials_clearcoat: "The index of refraction of clearcoat and base layer do not influence each other." Principled's
// base reflects by the ratio mix(base, base / coat, weight).
TEST(GltfMaterials, CoatsLeaveTheReflectanceBelowThem) {
  const TemporaryFolder folder;
  for (const double weight : {1.0, 0.5}) {
    Square square;
    std::string told;
    extended(square, "KHR_materials_clearcoat") = {{"clearcoatFactor", weight}, {"clearcoatRoughnessFactor", 0.1}};
    const Component& shader = square.shader(folder, told);
    EXPECT_EQ(told, "");
    const double ior = number(shader, "specular_ior");
    EXPECT_NEAR(ior * (1 - weight) + ior / number(shader, "coat_ior") * weight, 1.5, 1e-6) << weight;
  }
  Square square;
  extended(square, "KHR_materials_clearcoat") = {{"clearcoatFactor", 1}, {"clearcoatTexture", {{"index", 0}}}};
  EXPECT_NE(square.import(folder).told().find("what is under a coat"), std::string::npos);
}

// KHR_materials_variants: a primitive names the variants in which it has another material.
TEST(GltfMaterials, VariantsAreChosenByName) {
  const TemporaryFolder folder;
  Square square;
  square.json()["materials"].push_back({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.25}}}});
  square.json()["extensionsUsed"] = {"KHR_materials_variants"};
  square.json()["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "matt"}}, {{"name", "silk"}}};
  square.primitive()["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {1}}}};
  EXPECT_NE(square.import(folder).told().find("none of its 2 variants"), std::string::npos);
  EXPECT_EQ(constant(part(square.object(), "shader"), "specular_roughness"), 1);
  for (const auto& [name, roughness] : {std::pair{"matt", 1.0}, {"silk", 0.25}, {"1", 0.25}}) {
    EXPECT_EQ(square.import(folder, {{"variant", name}}).told(), "");
    EXPECT_EQ(constant(part(square.object(), "shader"), "specular_roughness"), roughness) << name;
  }
  EXPECT_NE(square.import(folder, {{"variant", "silky"}}).told().find("silk"), std::string::npos);
}

// KHR_materials_anisotropy: the rotation gives the direction of greater roughness, counter-clockwise from the tangent [rad].
TEST(GltfMaterials, StretchedHighlightsTurn) {
  const TemporaryFolder folder;
  Square square;
  std::string told;
  square.material()["pbrMetallicRoughness"]["roughnessFactor"] = 0.3;
  extended(square, "KHR_materials_anisotropy") = {{"anisotropyStrength", 0.5}, {"anisotropyRotation", 1.5707963267948966}};
  EXPECT_NEAR(constant(square.shader(folder, told), "geometry_tangent_rotation"), 0.25, 1e-6);
  EXPECT_EQ(told, "");
  extended(square, "KHR_materials_anisotropy")["anisotropyTexture"] = {{"index", 0}};
  EXPECT_NE(square.import(folder).told().find("whatever their texture says"), std::string::npos);
}

// KHR_materials_volume: after attenuationDistance white light has attenuationColor.
TEST(GltfMaterials, WhiteLightHasTheColourAfterTheDistance) {
  const TemporaryFolder folder;
  for (const std::array<double, 3>& wanted : {std::array{0.9, 0.4, 0.2}, {0.1, 0.5, 0.9}, {0.5, 0.5, 0.5}}) {
    Square square;
    extended(square, "KHR_materials_transmission")["transmissionFactor"] = 1;
    extended(square, "KHR_materials_volume") = {
        {"thicknessFactor", 1}, {"attenuationDistance", 0.25}, {"attenuationColor", wanted}};
    EXPECT_EQ(square.import(folder).told(), "");
    const Value absorption = get(part(square.object(), "interior"), "absorption");
    ASSERT_TRUE(absorption.as<Color>());
    std::vector<float> wavelengths, left;
    for (float nm = wavelength_low; nm <= wavelength_high; nm += 5) {
      wavelengths.push_back(nm);
      left.push_back(std::exp(-0.25f * (*absorption.as<Color>())->at(nm, ColorUse::coefficient)));
    }
    const std::array<double, 3> rgb = rgb_of(*table_spectrum(wavelengths, left));
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(rgb[i], wanted[i], 3e-3) << i;
  }
}

}  // namespace
}  // namespace etendue
