#pragma once
// How surfaces and media tell what they do to the polarization of light: interfaces that a Scatter, a VolumeShader or a
// PhaseFunction may implement besides its own. All others depolarize: what they scatter is unpolarized, whatever arrives, as it
// is for diffuse surfaces; but null scattering changes nothing.
//
// Only algorithms that follow polarization ask for it (transport/polarized_walk.h). Directions are sampled as for unpolarized
// light.

#include "etendue/core/mueller.h"
#include "etendue/phase_function.h"
#include "etendue/shader.h"

namespace etendue {

/// A BSDF that polarizes or preserves polarization.
class PolarizingScatter {
 public:
  /// What the lobes do to light that arrives from `in` and leaves towards `out`, in world directions. `lobes` is one specular
  /// lobe whose direction was sampled, or smooth_lobes: then all of them together. False: the light is depolarized, and
  /// `event` not set.
  virtual bool polarization(const Vector3& out, const Vector3& in, Lobes lobes, Polarization& event) const = 0;

 protected:
  ~PolarizingScatter() = default;
};

/// The same of any BSDF. What passes others straight on stays as it is.
inline bool polarization_of(const Scatter& scatter, const Vector3& out, const Vector3& in, Lobes lobes, Polarization& event) {
  if (const auto* polarizing = dynamic_cast<const PolarizingScatter*>(&scatter))
    return polarizing->polarization(out, in, lobes, event);
  if (lobes != null_scattering) return false;
  event.x_in = event.x_out = any_perpendicular(out);
  event.mueller = Mueller::identity();
  return true;
}

/// Adds a part of a mixture: `weight` is the scattering of unpolarized light by the part.
inline void add_part(PolarizationMean& mean, const Scatter& part, const Vector3& out, const Vector3& in, Lobes lobes,
                     const Spectrum& weight) {
  Polarization event;
  if (weight.black()) return;
  if (polarization_of(part, out, in, lobes, event))
    mean.add(weight, event);
  else
    mean.add_unpolarized(weight);
}

/// A medium that polarizes, which a VolumeShader may be.
class PolarizingVolume {
 public:
  /// As PolarizingScatter::polarization.
  virtual bool polarization(const Vector3& out, const Vector3& in, Polarization& event) const = 0;

 protected:
  ~PolarizingVolume() = default;
};

/// A phase function that polarizes, which a PhaseFunction may be.
class PolarizingPhase {
 public:
  /// The Mueller matrix over its first element, with the normal of the plane of both directions as the reference direction of
  /// light that arrives and of light that leaves. False: the light is depolarized.
  virtual bool polarization(float h, Mueller& mueller) const = 0;

 protected:
  ~PolarizingPhase() = default;
};

/// The same of any phase function.
inline bool polarization_of(const PhaseFunction& phase, float h, Mueller& mueller) {
  const auto* polarizing = dynamic_cast<const PolarizingPhase*>(&phase);
  return polarizing && polarizing->polarization(h, mueller);
}

/// A Shader whose surfaces change polarization without deflecting light, as a polarizing filter does. Renderers that do not
/// follow polarization show a part of what it does at best, and users are told so (render/follows_polarization.h).
class PolarizingPlate {
 protected:
  ~PolarizingPlate() = default;
  PolarizingPlate() = default;

 public:
  /// What it does, for users: "polarizes".
  virtual const char* deed() const = 0;
};

}  // namespace etendue
