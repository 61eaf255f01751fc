#pragma once
// TextureFiles: image files as textures of the shading language, by the textures of the house.
//
// Numbers are those that the file stores, without decoding, unless the option "colorspace" states an encoding. (0, 0) is the
// upper left corner. Outside the unit square a texture is black unless "wrap" says otherwise. Lookups are means over the
// ellipse that the coordinates' derivatives span, times "width" and widened by "blur"; without derivatives they interpolate
// between texels.

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

/// Thread-safe. Files are opened once; relative names are searched in the given folders.
class TextureFiles {
 public:
  explicit TextureFiles(std::vector<std::string> folders = {});
  ~TextureFiles();

  // As those of Services.
  std::string_view texture(const String* file, const Dual<float>& s, const Dual<float>& t, const TextureOptions&,
                           TextureLookup&);
  std::string_view environment(const String* file, const Dual<Triple>& direction, const TextureOptions&, TextureLookup&);
  bool texture_info(const String* file, const float* at, const String* name, const Type&, void* out);

 private:
  struct File;
  struct Facts;
  File& opened(const String*, const TextureOptions*);
  File& tile(const String* pattern, float s, float t, const TextureOptions*);
  const Facts& facts(File&);
  std::string found(const std::string& name) const;

  std::vector<std::string> folders_;
  std::shared_mutex mutex_;
  std::map<std::pair<const String*, const String*>, std::unique_ptr<File>> files_;  // by name and colour space
};

}  // namespace etendue::osl
