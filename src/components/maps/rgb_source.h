#pragma once
// RgbSource: interface of maps that hold RGB, for callers that need the three numbers and not a spectrum made from them.

#include "etendue/object_map.h"

namespace etendue {

class RgbSource {
 public:
  /// Whether the map holds RGB. A map that evaluates another map returns whether that map holds RGB.
  virtual bool has_rgb() const { return true; }
  /// Writes the three numbers at a point, decoded by the map's transfer function.
  virtual void rgb(const SurfacePoint&, float out[3]) const = 0;
  /// The name of the space in which they are RGB (rgb_space).
  virtual std::string rgb_space_name() const { return "srgb"; }

 protected:
  ~RgbSource() = default;
};

/// The map as an RgbSource, or null if it holds no RGB.
inline const RgbSource* rgb_source(const ObjectMap& map) {
  const auto* source = dynamic_cast<const RgbSource*>(&map);
  return source && source->has_rgb() ? source : nullptr;
}

}  // namespace etendue
