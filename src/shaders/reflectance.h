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

/// Throws at the member when the map is missing, or has one colour everywhere that is no reflectance.
inline void require_reflectance(const Component& owner, const char* member, const Ref<ObjectMap>& map) {
  if (!map) owner.fail(member, "a map or a colour is needed");
  const Color color = map->constant();
  if (!color) return;
  for (float lambda = wavelength_low; lambda <= wavelength_high; lambda += 5) {
    const float value = color->at(lambda, ColorUse::reflectance);
    if (!(value >= 0 && value <= 1.0001f))
      owner.fail(member, "a reflectance lies between 0 and 1, and this is " + std::to_string(value) + " at " +
                             std::to_string(int(lambda)) + " nm");
  }
}

}  // namespace etendue
