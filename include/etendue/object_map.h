#pragma once
// ObjectMap: the interface of textures (Texture in pbrt and Mitsuba): a scalar or a colour at a surface point.
//
// A new map must implement `color` and `scalar`. Optional: `constant` if it is the same everywhere, `largest`.

#include "etendue/core/spectral_function.h"
#include "etendue/core/surface_point.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

class ObjectMap : public Component {
 public:
  using Interface = ObjectMap;
  using Parent = Component;
  static void describe(Description<ObjectMap>&);

  /// The colour at the point, at the path's wavelengths. An RGB value is converted to a spectrum according to its ColorUse. The
  /// result for ColorUse::reflectance lies in [0, 1].
  virtual Spectrum color(const SurfacePoint&, const Wavelengths&, ColorUse) const = 0;
  /// A single number at the point (a roughness, a weight); for a colour its mean over the channels or wavelengths.
  virtual float scalar(const SurfacePoint&) const = 0;
  /// The colour of a map that is the same everywhere, else null. Used for precomputation before rendering.
  virtual Color constant() const { return nullptr; }

  /// The largest number in the map's data, such as an image's texels (for a constant map see its colour). Shaders clamp values
  /// above 1 where they need a reflectance. 0: unknown, or no value exceeds 1.
  virtual float largest() const { return 0; }

  Spectrum reflectance(const SurfacePoint& p, const Wavelengths& w) const { return color(p, w, ColorUse::reflectance); }
};

/// Makes a ConstantMap, for the default value of a member.
Ref<ObjectMap> constant(float value);

}  // namespace etendue
