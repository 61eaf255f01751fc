#pragma once
// ExposedToneMap: the base of tone maps that start with an exposure, which is given or computed from the image. A subclass must
// implement `develop`.

#include "etendue/tone_map.h"

namespace etendue {

/// Multiplies the image by a factor such that middle grey is 0.18, then applies the operator `develop`.
class ExposedToneMap : public ToneMap {
 public:
  using Interface = ExposedToneMap;
  using Parent = ToneMap;
  static void describe(Description<ExposedToneMap>&);

  enum class Exposure : std::uint8_t { automatic, fixed };
  Exposure exposure = Exposure::automatic;
  float stops = 0;        ///< binary logarithm of a factor; added to the automatic exposure
  float percentile = 95;  ///< of automatic exposure: brighter pixels are clamped to this percentile of the lit pixels'
                          ///< luminance, and pixels far darker than it do not count

  /// The factor by which an image in X Y Z is multiplied, positive and finite.
  double exposure_factor(const Image& xyz) const;

 protected:
  /// Replaces values that are not finite (NaN becomes black), multiplies by the exposure, then calls `develop`.
  void map(Image& xyz) const final;
  /// The operator: from exposed X Y Z to X Y Z where Y = 1 is the display's white, in place. The values are finite.
  virtual void develop(Image& xyz) const = 0;
};

}  // namespace etendue
