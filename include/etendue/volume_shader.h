#pragma once
// VolumeShader: a participating medium. Distance sampling and transmittance are not here but in the transport library
// (transport/medium.h), once for all media.

#include "etendue/core/ray.h"
#include "etendue/core/spectrum.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// Coefficients at a point [1/m of the scene], and emitted radiance per distance [W m^-3 sr^-1 nm^-1].
struct VolumeCoefficients {
  Spectrum absorption, scattering, emission;
  Spectrum extinction() const { return absorption + scattering; }
};

class VolumeShader : public Component {
 public:
  using Interface = VolumeShader;
  using Parent = Component;
  static void describe(Description<VolumeShader>&);

  // Points are in the own coordinates of the object whose inside the medium fills, as the user wrote them, from their true
  // origin (a medium that is the same everywhere may get others); directions are those of the scene. Nothing here draws numbers
  // or remembers: tracking asks for one place again and again, from many threads.

  virtual VolumeCoefficients coefficients(const Point3&, float time, const Wavelengths&) const = 0;
  /// Coefficients are the same everywhere: free paths then have a closed form.
  virtual bool homogeneous() const = 0;
  /// Whether it sends out light of its own.
  virtual bool emits() const { return false; }
  /// A bound of the extinction [1/m] over the medium, per wavelength: the closer, the faster. A medium that exceeds it
  /// somewhere is rendered wrongly, so `conform` looks for such places.
  virtual Spectrum majorant(const Wavelengths&) const = 0;
  /// Phase function [1/sr] for light that turns from travelling along -out to travelling along in; integrates to 1.
  virtual float phase(const Point3&, const Vector3& out, const Vector3& in) const = 0;
  /// A direction drawn exactly in proportion to `phase`, and its density [1/sr], which is therefore the same number: walks
  /// count on phase / density = 1.
  virtual Vector3 sample_phase(const Point3&, const Vector3& out, Point2 u, float& pdf) const = 0;
};

}  // namespace etendue
