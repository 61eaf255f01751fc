#pragma once
// ObjectMap (a texture): a scalar or a colour at a surface point.

#include "etendue/core/ray.h"
#include "etendue/core/spectral_function.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

class ObjectMap : public Component {
 public:
  using Interface = ObjectMap;
  using Parent = Component;
  static void describe(Description<ObjectMap>&);

  /// The colour at the point, at the path's wavelengths. Who asks says what for: a map given in RGB becomes a
  /// spectrum accordingly. As a reflectance it lies in [0, 1].
  virtual Spectrum color(const SurfacePoint&, const Wavelengths&, ColorUse) const = 0;
  /// A single number at the point (a roughness, a weight): of a colour, its mean over the channels or wavelengths.
  virtual float scalar(const SurfacePoint&) const = 0;
  /// The map's only colour when it is the same everywhere, else null: for what is computed once, before rendering.
  virtual Color constant() const { return nullptr; }

  /// The largest number it was given as a whole (an image's texels; a constant's colour is asked itself). What is more than 1
  /// shaders cut where they need a reflectance. 0: not known, or within.
  virtual float largest() const { return 0; }

  Spectrum reflectance(const SurfacePoint& p, const Wavelengths& w) const { return color(p, w, ColorUse::reflectance); }
};

/// A ConstantMap: how a class states its default.
Ref<ObjectMap> constant(float value);

}  // namespace etendue
