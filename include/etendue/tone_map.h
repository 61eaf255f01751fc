#pragma once
// ToneMap: maps an image in unbounded CIE XYZ to the RGB values of a display or file. pbrt and Mitsuba have no such plugin
// type.
//
// A new tone map must implement `map`, its operator from X Y Z to X Y Z; if it starts with an exposure it derives from
// ExposedToneMap (exposed_tone_map.h). Optional: `clips`, `local`.

#include "etendue/core/image.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// The conversion to an RGB space and the transfer function are implemented here, for all tone maps.
class ToneMap : public Component {
 public:
  using Interface = ToneMap;
  using Parent = Component;
  static void describe(Description<ToneMap>&);

  std::string color_space = "srgb";  ///< primaries and white of the result: a name of rgb_space() (describe/color.h)
  std::string transfer = "srgb";     ///< encoding of the result: "srgb", "linear", "rec709", "gamma2.2", …

  /// From X Y Z (further channels are dropped) to R G B: the operator, then the RGB space, then clipping to [0, 1] when
  /// `clip`, then the transfer function.
  Image apply(const Image& xyz) const;

  /// Whether the result is clipped to [0, 1] (by all tone maps except the identity).
  virtual bool clips() const { return true; }
  /// Whether the operator is local: the result of a pixel depends on its neighbours (dodging and burning), so that equal pixels
  /// may become different.
  virtual bool local() const { return false; }

 protected:
  /// The operator: X Y Z to X Y Z, in place. Parameters that it computed may be stored in the image's metadata.
  virtual void map(Image& xyz) const = 0;
};

}  // namespace etendue
