// Which image a texture of glTF has, by the extensions for other formats.

#include <gtest/gtest.h>

#include "gltf_support.h"

namespace etendue {
namespace {

using namespace gltf_test;

/// A square with an image as its colour, which a texture's extension names too.
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

}  // namespace
}  // namespace etendue
