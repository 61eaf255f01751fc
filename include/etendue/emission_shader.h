#pragma once
// EmissionShader: how light leaves a luminaire. An object that has one is a luminaire.

#include "etendue/core/ray.h"
#include "etendue/core/spectrum.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// Which sides of a surface do something.
enum class Sides : std::uint8_t { front, back, both };
/// What becomes of light that a shading normal would send through the surface; see scatter_answers.h.
enum class ShadingNormals : std::uint8_t { folded, clipped };

/// A direction with its solid-angle density.
struct DirectionSample {
  Vector3 direction;
  float pdf = 0;  ///< [1/sr]
};

class EmissionShader : public Component {
 public:
  using Interface = EmissionShader;
  using Parent = Component;
  static void describe(Description<EmissionShader>&);

  /// Radiance [W m^-2 sr^-1 nm^-1] that leaves the point in a direction (unit, away from the surface). Zero on a side
  /// that does not emit. For a luminaire at infinity: the radiance that arrives from `-direction`.
  virtual Spectrum radiance(const SurfacePoint&, const Vector3& direction, const Wavelengths&) const = 0;

  /// A direction in which light leaves the point, for algorithms that start at luminaires; the density is
  /// [1/sr] over the emitting sides together.
  virtual DirectionSample sample(const SurfacePoint&, Point2 u) const = 0;
  virtual float pdf(const SurfacePoint&, const Vector3& direction) const = 0;

  /// Power [W/nm] the object emits at each wavelength, from its whole area.
  virtual Spectrum power(const SceneObject&, const Wavelengths&) const = 0;

  /// For luminaires at infinity that know where their light comes from: a direction towards the light and its density
  /// [1/sr], and the density of a given one. Others return density 0, and are sampled uniformly.
  virtual DirectionSample sample_incident(Point2) const { return {}; }
  virtual float incident_pdf(const Vector3&) const { return 0; }
  virtual bool knows_incident() const { return false; }
  /// Whether it only makes sense at infinity: its light depends on where it comes from, not on a surface.
  virtual bool only_at_infinity() const { return false; }

  /// The objects that have it are others than before, or were prepared again: what was found out about them is forgotten. By
  /// Scene::prepare, for every luminaire.
  virtual void objects_changed() {}

  /// A point without a normal, on an object without extent, emits in all directions.
  bool emits(const SurfacePoint& p, const Vector3& direction) const {
    if (sides == Sides::both || p.normal == Normal3{}) return true;
    return (dot(p.normal, direction) > 0) == (sides == Sides::front);
  }

  Sides sides = Sides::front;
};

}  // namespace etendue
