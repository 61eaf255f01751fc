#pragma once
// ShownGeometry: base class of maps that show geometric quantities of a point as colours.

#include "etendue/describe/color.h"
#include "etendue/object_map.h"

namespace etendue {

/// A map whose colour is given by three numbers in [0, 1] as linear RGB with the primaries of sRGB.
class ShownGeometry : public ObjectMap {
 public:
  void prepare() override { space_ = &rgb_space("srgb"); }
  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const final {
    const Vector3 c = shown(p);
    return rgb_spectrum(*space_, c.x, c.y, c.z, use, w);
  }
  float scalar(const SurfacePoint& p) const final {
    const Vector3 c = shown(p);
    return (c.x + c.y + c.z) / 3;
  }

 protected:
  virtual Vector3 shown(const SurfacePoint&) const = 0;
  /// Clamps to [0, 1]; NaN becomes 0.
  static float fraction(float x) { return x > 0 ? std::min(x, 1.0f) : 0; }

 private:
  const RgbSpace* space_ = nullptr;
};

}  // namespace etendue
