// Materials of glTF against the formulas of its specification (appendix B) and of the KHR_materials extensions.

#include "gltf_support.h"

namespace etendue {
namespace {

using namespace gltf_test;

/// A picture of one pixel, white with an alpha of 128/255.
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

// Fibres are never sharper here than an alpha of 0.1.
TEST(GltfMaterials, SheenSharperThanThereIsIsTold) {
  const TemporaryFolder folder;
  Square square;
  extended(square, "KHR_materials_sheen") = {{"sheenColorFactor", {1, 1, 1}}};
  EXPECT_NE(square.import(folder).told().find("a roughness of fibres of 0 becomes"), std::string::npos);
}

}  // namespace
}  // namespace etendue
