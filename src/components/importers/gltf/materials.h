#pragma once
// Converts materials of glTF files, and their textures.

#include <map>

#include "components/importers/models/surface.h"
#include "document.h"

namespace etendue::gltf {

/// A converted material, and the set of texture coordinates that its textures use.
struct Material {
  MadeSurface made;
  size_t uv_set = 0;
  bool by_tangents = false;  ///< has a normal map or anisotropy
  double glow = 0;  ///< mean luminance of the emission if it is above a display's white or has an emissive strength; else 0
};

/// Whether a material extension is supported, or makes no difference in a path tracer.
bool is_known_material_extension(std::string_view name);

/// Whether a texture extension is supported, or a warning is added where a texture has it.
bool is_known_texture_extension(std::string_view name);

class Materials {
 public:
  Materials(Importing& importing, const Document& document) : importing_(importing), document_(document) {}

  /// The converted material, cached. `colored`: vertices have colours; `faded`: their colours have alpha. Nothing as
  /// `material`: the default material.
  const Material& get(std::optional<size_t> material, bool colored, bool faded);

  /// An image of the file on the unit square; nothing, with a warning, if it cannot be read.
  std::optional<SurfaceTexture> image_texture(size_t index, bool* has_alpha = nullptr);
  // Material properties in files of our own converters (described.h).
  SurfaceColor described_color(const Json&);

 private:
  struct Image {
    std::optional<SurfaceTexture> texture;
    bool has_alpha = false;
  };
  using Key = std::tuple<std::optional<size_t>, bool, bool>;

  Surface read(const Json& material);
  void read_metal(const Json& pbr, Surface&);
  void read_specular_glossiness(const Json& old, Surface&);
  void read_extensions(const Json& extensions, Surface&);
  void read_specular(const Json&, Surface&);
  void keep_metal(Surface&);
  void reflect(const SurfaceColor& straight_on, Surface&);
  void read_volume(const Json& extensions, Surface&);
  std::optional<size_t> image_of(const Json& texture);
  std::optional<SurfaceTexture> texture(const Json& object, const char* key, bool* has_alpha = nullptr);
  SurfaceColor color(const Json& object, const char* factor, const char* texture_key, double otherwise);
  SurfaceNumber number(const Json& object, const char* factor, double otherwise, const char* texture_key, const char* channel);
  const Image& image(size_t index);
  void note_unknown(const Json& extensions);
  bool is_listed(const std::string& extension) const;
  std::optional<SurfaceTexture> described_texture(const Json&, bool* has_alpha);
  SurfaceNumber described_number(const Json&);
  void read_described(const Json&, Surface&);
  std::optional<Material> materialx(const Json& source);
  Location at() const { return importing_.at(); }

  Importing& importing_;
  const Document& document_;
  std::map<Key, Material> made_;
  std::map<size_t, Image> images_;
  std::optional<size_t> uv_set_;  // of the material being read
};

}  // namespace etendue::gltf
