#pragma once
// ExposedToneMap: tone maps that begin as a camera does, with an exposure, given or found from the picture.

#include "etendue/tone_map.h"

namespace etendue {

/// Multiplies the picture by a factor such that middle grey is 0.18, then hands it to the operator.
class ExposedToneMap : public ToneMap {
 public:
  using Interface = ExposedToneMap;
  using Parent = ToneMap;
  static void describe(Description<ExposedToneMap>&);

  enum class Exposure : std::uint8_t { automatic, fixed };
  Exposure exposure = Exposure::automatic;
  float stops = 0;        ///< powers of two; added to what is automatic
  float percentile = 95;  ///< what is brighter than this percentage of the lit pixels does not count, nor what is far darker

  /// The factor by which this picture in X Y Z is multiplied, positive and finite.
  double exposure_factor(const Image& xyz) const;

 protected:
  /// Exposes, with numbers that are not finite made so (not a number: black), then `develop`.
  void map(Image& xyz) const final;
  /// The operator: exposed X Y Z to X Y Z where Y = 1 is the display's white, in place. Values are finite.
  virtual void develop(Image& xyz) const = 0;
};

}  // namespace etendue
