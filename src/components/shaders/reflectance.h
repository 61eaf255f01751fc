#pragma once
// What shaders ask of a reflectance.

#include "etendue/object_map.h"

namespace etendue {

/// A map's reflectance at a point, kept within [0, 1] whatever the map holds.
inline Spectrum reflectance_at(const ObjectMap& map, const SurfacePoint& p, const Wavelengths& w) {
  const detail::Lanes v = map.reflectance(p, w).lanes(), zero{}, one = zero + 1.0f;
  const detail::Lanes low = v > zero ? v : zero;  // not-a-number becomes 0
  return Spectrum(low < one ? low : one);
}

/// Throws at the member when the map is missing, or has one colour everywhere that is no reflectance; warns where an image or a
/// colour's components are brighter than a reflectance can be.
void require_reflectance(const Component& owner, const char* member, const Ref<ObjectMap>& map);

/// Warns where two reflectances that are the same everywhere exceed 1 together, and are scaled down for it.
void warn_of_sum(const Component& owner, const char* first_member, const Ref<ObjectMap>& first, const char* second_member,
                 const Ref<ObjectMap>& second);

}  // namespace etendue
