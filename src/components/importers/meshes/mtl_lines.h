#pragma once
// What an MTL file says of a material, line by line.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "components/importers/models/surface.h"

namespace etendue {

struct MtlTexture {
  SurfaceTexture image;
  std::string channel;
  double bump = 1, base = 0, gain = 1;  // what it says is base + gain * texel
  bool has_alpha = false, has_colors = false;
};

/// The lines of one material, before it is known what they mean together.
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

/// Of 'Tr' there are two meanings. By most it is the transparency, 1 - d; MeshLab's library (vcglib) and others write the
/// opacity itself, 1 for what is opaque. Whether all materials of a file mean the latter, which is told at the first.
bool tr_is_opacity(Importing&, const std::vector<MtlLines>&, bool by_meshlab);

/// What of a surface is there, by 'd' and 'Tr'.
double mtl_opacity(Importing&, const MtlLines&, bool tr_is_opacity);

}  // namespace etendue
