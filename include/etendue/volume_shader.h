#pragma once
// VolumeShader: a participating medium (Medium in pbrt and Mitsuba): its coefficients and phase function. Distance sampling and
// transmittance are implemented once for all media in transport/medium.h.
//
// A new medium must implement `coefficients`, `homogeneous`, `majorant`, `phase` and `sample_phase`. Optional: `emits`.

#include "etendue/core/ray.h"
#include "etendue/core/spectrum.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// The coefficients at a point [1/m, in world space], and the emitted radiance per distance [W m^-3 sr^-1 nm^-1].
struct VolumeCoefficients {
  Spectrum absorption, scattering, emission;
  Spectrum extinction() const { return absorption + scattering; }
};

class VolumeShader : public Component {
 public:
  using Interface = VolumeShader;
  using Parent = Component;
  static void describe(Description<VolumeShader>&);

  // Points are in object space of the object that the medium fills, as written by the user, relative to the true origin of
  // object space (a homogeneous medium may get other points). Directions are in world space. These functions use no random
  // numbers and have no state: delta tracking calls them for the same point repeatedly, from many threads.

  virtual VolumeCoefficients coefficients(const Point3&, float time, const Wavelengths&) const = 0;
  /// Whether the coefficients are the same everywhere: free paths are then sampled in closed form.
  virtual bool homogeneous() const = 0;
  /// Whether the medium emits light.
  virtual bool emits() const { return false; }
  /// An upper bound of the extinction [1/m] over the whole medium, per wavelength; the tighter, the faster is delta tracking.
  /// Where the extinction exceeds it, null collisions have a negative coefficient that counts as 0: the medium is too thin
  /// there. `etendue conform` searches for such points.
  virtual Spectrum majorant(const Wavelengths&) const = 0;
  /// The phase function [1/sr] for the scattering of light from the direction of travel -out into in; it integrates to 1.
  virtual float phase(const Point3&, const Vector3& out, const Vector3& in) const = 0;
  /// Samples a direction exactly in proportion to `phase`. Its pdf [1/sr] therefore equals `phase`: walks use phase / pdf = 1.
  virtual Vector3 sample_phase(const Point3&, const Vector3& out, Point2 u, float& pdf) const = 0;
};

}  // namespace etendue
