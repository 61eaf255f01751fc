#pragma once
// BoundedMap: maps that know how large their values may become. Media whose coefficients are maps need it: light is followed
// through them by a bound of the extinction.

#include <algorithm>

#include "etendue/object_map.h"

namespace etendue {

class BoundedMap {
 public:
  /// No number of the map, and no colour of it that is asked for as a coefficient, is larger anywhere, of either sign.
  /// Infinite: nobody knows.
  virtual float bound() const = 0;

 protected:
  ~BoundedMap() = default;
};

/// The bound of any map, infinite where it cannot tell.
inline float bound_of(const ObjectMap& map) {
  if (const Color all = map.constant()) {
    const ValueRange range = range_of(*all, ColorUse::coefficient);
    return std::max(range.most, -range.least);
  }
  const auto* bounded = dynamic_cast<const BoundedMap*>(&map);
  return bounded ? bounded->bound() : infinity;
}

}  // namespace etendue
