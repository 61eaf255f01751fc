#pragma once
// Evaluation and checks of reflectance maps, for shaders.

#include "etendue/object_map.h"

namespace etendue {

/// A map's reflectance at a point, clamped to [0, 1].
inline Spectrum reflectance_at(const ObjectMap& map, const SurfacePoint& p, const Wavelengths& w) {
  const detail::Lanes v = map.reflectance(p, w).lanes(), zero{}, one = zero + 1.0f;
  const detail::Lanes low = v > zero ? v : zero;  // not-a-number becomes 0
  return Spectrum(low < one ? low : one);
}

/// Throws Error at the member if the map is missing, or if it is a constant colour outside [0, 1]. Warns if components of an
/// image or of a colour exceed 1.
void require_reflectance(const Component& owner, const char* member, const Ref<ObjectMap>& map);

/// Warns if the sum of two constant reflectances exceeds 1, in which case the shader scales both down.
void warn_of_sum(const Component& owner, const char* first_member, const Ref<ObjectMap>& first, const char* second_member,
                 const Ref<ObjectMap>& second);

}  // namespace etendue
