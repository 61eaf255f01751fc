#pragma once
// A picture with its light groups weighed.

#include <array>
#include <map>
#include <string>

#include "etendue/core/image.h"

namespace etendue::studio {

/// The picture, X Y Z and layers, as it would be were the light of each group (layers light.NAME) multiplied by factors of
/// linear sRGB; groups that are not named stay. Layers that say how noisy the picture was, or hold its light by path length,
/// would be of another picture and are left out. Throws Error when there are no groups, or a name is of none.
Image relit(const Image&, const std::map<std::string, std::array<double, 3>>& factors);

}  // namespace etendue::studio
