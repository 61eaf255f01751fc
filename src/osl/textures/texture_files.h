#pragma once
// TextureFiles: image files as textures of the shading language, by the textures of the house.
//
// Numbers are those that the file stores, without decoding, unless the option "colorspace" states an encoding. (0, 0) is the
// upper left corner. Outside the unit square a texture is black unless "wrap" says otherwise. Lookups are means over the
// ellipse that the coordinates' derivatives span, times "width" and widened by "blur"; without derivatives they interpolate
// between texels.

#include <compare>
#include <map>
#include <memory>
#include <shared_mutex>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "osl/library/services.h"

namespace etendue {
class ImageTexture;
}

namespace etendue::osl {

/// A file as a shader names it. A relative name is searched in the folder of the shader, then in that of the scene, then in the
/// given folders and the working folder.
struct TextureName {
  const String* text;
  const char *shader_file = "", *scene_file = "";  ///< interned; empty: there is none
  auto operator<=>(const TextureName&) const = default;
};

/// Thread-safe. Files are opened once.
class TextureFiles {
 public:
  explicit TextureFiles(std::vector<std::string> folders = {});
  ~TextureFiles();

  // As those of Services.
  std::string_view texture(const TextureName&, const Dual<float>& s, const Dual<float>& t, const TextureOptions&,
                           TextureLookup&);
  std::string_view environment(const TextureName&, const Dual<Triple>& direction, const TextureOptions&, TextureLookup&);
  bool texture_info(const TextureName&, const float* at, const String* name, const Type&, void* out);

 private:
  struct File;
  struct Facts;
  File& opened(const TextureName&, const TextureOptions*);
  File& tile(const TextureName& pattern, float s, float t, const TextureOptions*);
  const Facts& facts(File&);
  std::vector<std::string> folders_of(const TextureName&) const;
  std::string found(const TextureName&) const;

  std::vector<std::string> folders_;
  std::shared_mutex mutex_;
  std::map<std::pair<TextureName, const String*>, std::unique_ptr<File>> files_;  // by name and colour space
};

}  // namespace etendue::osl
