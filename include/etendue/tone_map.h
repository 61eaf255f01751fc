#pragma once
// ToneMap: one picture into another, from CIE XYZ without bounds to values a display or file takes.

#include "etendue/core/image.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// Ends in an RGB space and a transfer function, both chosen here for all tone maps.
class ToneMap : public Component {
 public:
  using Interface = ToneMap;
  using Parent = Component;
  static void describe(Description<ToneMap>&);

  std::string color_space = "srgb";  ///< primaries and white of the result: a name known to the colour library
  std::string transfer = "srgb";     ///< encoding of the result: "srgb", "linear", "rec709", "gamma2.2", …

  /// From X Y Z (further channels are dropped) to R G B: the operator, then the RGB space, then clipping to [0, 1] when
  /// `clip`, then the transfer function.
  Image apply(const Image& xyz) const;

  /// Whether the result is bounded to [0, 1] (all but the map that changes nothing).
  virtual bool clips() const { return true; }
  /// Whether what becomes of a pixel depends on those around it (dodging and burning): equal pixels may then differ.
  virtual bool local() const { return false; }

 protected:
  /// The operator: X Y Z to X Y Z, in place. What it has found out may go to the image's metadata.
  virtual void map(Image& xyz) const = 0;
};

}  // namespace etendue
