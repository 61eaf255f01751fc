#pragma once
// The properties of a material as an MTL file states them, before they are interpreted.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "components/importers/models/surface.h"

namespace etendue {

struct MtlTexture {
  SurfaceTexture image;
  std::string channel;
  double bump = 1, base = 0, gain = 1;  // the value is base + gain * texel
  bool has_alpha = false, has_colors = false;
};

/// The lines of one material, not yet interpreted together.
struct MtlLines {
  std::string name;
  Location at;
  std::map<std::string, double> numbers;
  std::map<std::string, std::array<double, 3>> colors;
  std::map<std::string, MtlTexture> textures;
  bool has(const char* key) const { return numbers.contains(key) || colors.contains(key) || textures.contains(key); }
  double number(const char* key, double otherwise) const {
    const auto found = numbers.find(key);
    return found == numbers.end() ? otherwise : found->second;
  }
  std::array<double, 3> color(const char* key, double otherwise) const {
    const auto found = colors.find(key);
    return found == colors.end() ? std::array<double, 3>{otherwise, otherwise, otherwise} : found->second;
  }
  const MtlTexture* texture(const char* key) const {
    const auto found = textures.find(key);
    return found == textures.end() ? nullptr : &found->second;
  }
};

/// 'Tr' has two meanings. Most programs write the transparency, 1 - d; MeshLab's library (vcglib) and others write the opacity
/// itself, 1 for opaque. Returns whether all materials of a file mean the opacity, and then adds a warning at the first one.
bool tr_is_opacity(Importing&, const std::vector<MtlLines>&, bool by_meshlab);

/// The opacity of a material from 'd' and 'Tr'.
double mtl_opacity(Importing&, const MtlLines&, bool tr_is_opacity);

}  // namespace etendue
