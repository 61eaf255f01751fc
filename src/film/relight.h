#pragma once
// Relighting: a picture with weighted light groups.

#include <array>
#include <map>
#include <string>

#include "etendue/core/image.h"

namespace etendue {

/// The picture, X Y Z and layers, with the light of each group (layers light.NAME) multiplied by factors in linear sRGB; groups
/// without factors stay unchanged. Layers of the noise, and of the light by path length, would not match and are left out.
/// Throws Error if there are no groups, or a name is not a group.
Image relit(const Image&, const std::map<std::string, std::array<double, 3>>& factors);

}  // namespace etendue
