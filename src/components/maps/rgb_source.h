#pragma once
// RgbSource: maps that hold red, green and blue, for who needs the three numbers themselves and not a spectrum made of them.

#include "etendue/object_map.h"

namespace etendue {

class RgbSource {
 public:
  /// Whether there are such numbers; of a map of another map, whether there are of that.
  virtual bool has_rgb() const { return true; }
  /// Writes the three numbers at a point, after the decoding the map is told of.
  virtual void rgb(const SurfacePoint&, float out[3]) const = 0;

 protected:
  ~RgbSource() = default;
};

/// The map as one, or null when it has none.
inline const RgbSource* rgb_source(const ObjectMap& map) {
  const auto* source = dynamic_cast<const RgbSource*>(&map);
  return source && source->has_rgb() ? source : nullptr;
}

}  // namespace etendue
