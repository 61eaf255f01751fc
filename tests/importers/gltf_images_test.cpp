// The image that a glTF texture refers to, with the extensions for other image formats.

#include <gtest/gtest.h>

#include "gltf_support.h"

namespace etendue {
namespace {

using namespace gltf_test;

/// A square with an image as its colour; an extension of the texture names the image too.
Square textured(const char* extension) {
  Square square;
  square.material()["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  square.json()["textures"][0]["extensions"][extension]["source"] = 0;
  square.json()["extensionsUsed"] = {extension};
  return square;
}

TEST(GltfImages, FormatsThatAreNotReadAreTold) {
  const TemporaryFolder folder;
  for (const char* extension : {"KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"}) {
    Square square = textured(extension);
    std::string told;
    std::string with = class_of(square.shader(folder, told), "base_color");
    EXPECT_EQ(with, "ImageMap") << extension;
    EXPECT_NE(told.find(extension), std::string::npos) << told;
    EXPECT_NE(told.find("those that stand beside them are used"), std::string::npos) << told;
    square.json()["textures"][0].erase("source");
    square.json()["extensionsRequired"] = {extension};
    const std::string without = class_of(square.shader(folder, told), "base_color");
    EXPECT_NE(without, "ImageMap") << extension;
    EXPECT_NE(told.find(std::string(extension) + ") are not read: they are left out"), std::string::npos) << told;
  }
}

TEST(GltfImages, WebpComesBeforeWhatStandsBesideIt) {
  const TemporaryFolder folder;
  Square square = textured("EXT_texture_webp");
  square.json()["images"].push_back({{"uri", "not there.png"}});
  square.json()["textures"][0]["source"] = 1;
  square.json()["extensionsRequired"] = {"EXT_texture_webp"};
  std::string told;
  EXPECT_EQ(class_of(square.shader(folder, told), "base_color"), "ImageMap");
  EXPECT_EQ(told, "");
}

// gltfpack writes a scale of 0 where all surface coordinates lie in one line.
TEST(GltfImages, OneRowOfAnImage) {
  const TemporaryFolder folder;
  Square square = textured("EXT_texture_webp");
  square.material()["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.25, 0.5}}, {"scale", {3, 0}}};
  std::string told;
  const Component& map = part(square.shader(folder, told), "base_color");
  ASSERT_EQ(map.class_info().name, "UvTransformMap");
  const Value value = get(map, "scale");
  const std::vector<double> scale = value.as<Numbers>()->values;
  EXPECT_EQ(scale.at(0), 3);
  EXPECT_GT(scale.at(1), 0);
  EXPECT_LT(scale.at(1), 1e-5);
  EXPECT_NO_THROW(const_cast<Component&>(map).prepare());
}

}  // namespace
}  // namespace etendue
