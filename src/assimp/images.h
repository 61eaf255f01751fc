#pragma once
// Adds the images of Assimp's scenes to glTF: embedded ones as files in the buffer, others by their path.

#include <assimp/scene.h>

#include <map>
#include <string>

#include "glb.h"

namespace etendue::assimp_helper {

class ImageWriter {
 public:
  ImageWriter(const aiScene& scene, Glb& glb) : scene_(scene), glb_(glb) {}

  /// The index in the .glb of the image that a material's texture names.
  size_t index(const std::string& path);

 private:
  /// An image that is embedded as a file in its format.
  Json compressed(const aiTexture&);
  /// An image of separate texels, as a BMP file of 32 bits per pixel, whose rows run upwards.
  Json uncompressed(const aiTexture&);

  const aiScene& scene_;
  Glb& glb_;
  std::map<std::string, size_t> written_;
};

}  // namespace etendue::assimp_helper
