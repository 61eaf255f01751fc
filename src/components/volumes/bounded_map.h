#pragma once
// BoundedMap: interface of maps that have an upper bound of their values. Media whose coefficients are maps need it for the
// majorant of the extinction (delta tracking).

#include <algorithm>

#include "etendue/object_map.h"

namespace etendue {

class BoundedMap {
 public:
  /// An upper bound of the absolute values of the map's numbers, and of its spectra as coefficients, at all points. Infinite:
  /// not known.
  virtual float bound() const = 0;

 protected:
  ~BoundedMap() = default;
};

/// The upper bound of any map; infinite if it is not known.
inline float bound_of(const ObjectMap& map) {
  if (const Color all = map.constant()) {
    const ValueRange range = range_of(*all, ColorUse::coefficient);
    return std::max(range.most, -range.least);
  }
  const auto* bounded = dynamic_cast<const BoundedMap*>(&map);
  return bounded ? bounded->bound() : infinity;
}

}  // namespace etendue
