#pragma once
// EmissionShader: the emission profile of light sources (Light in pbrt, Emitter in Mitsuba): radiance by point and direction.
// An object with an EmissionShader is a luminaire (an emitter); its shape is the SceneObject.
//
// A new emission must implement `radiance`, `sample` with `pdf` (directions of emission, for paths that start at lights) and
// `power`. Optional, for light from infinity: `sample_incident`, `incident_pdf` and `knows_incident` (importance sampling of an
// environment map; `incident_places`, its inverse), `only_at_infinity`. Optional: `objects_changed` to drop cached values.

#include "etendue/core/spectrum.h"
#include "etendue/core/surface_point.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

/// A sampled direction with its pdf per solid angle.
struct DirectionSample {
  Vector3 direction;
  float pdf = 0;  ///< [1/sr]
};

/// The points of the unit square that a sampling function maps to one direction, each with the pdf [1/sr] with which it samples
/// the direction from there: their sum is the pdf of the direction.
struct IncidentPlaces {
  static constexpr int most = 2;
  int count = 0;
  Point2 at[most];
  float pdf[most] = {};
  void add(Point2 place, float part) {
    at[count] = place;
    pdf[count++] = part;
  }
};

class EmissionShader : public Component {
 public:
  using Interface = EmissionShader;
  using Parent = Component;
  static void describe(Description<EmissionShader>&);

  /// The emitted radiance [W m^-2 sr^-1 nm^-1] in a direction (unit, away from the surface). Zero on a side that does not emit.
  /// For a luminaire at infinity: the radiance that arrives from `-direction`.
  virtual Spectrum radiance(const SurfacePoint&, const Vector3& direction, const Wavelengths&) const = 0;

  /// Samples a direction of emission at the point, for paths that start at luminaires. The pdf is [1/sr] over all emitting
  /// sides together.
  virtual DirectionSample sample(const SurfacePoint&, Point2 u) const = 0;
  virtual float pdf(const SurfacePoint&, const Vector3& direction) const = 0;

  /// Power [W/nm] the object emits at each wavelength, from its whole area.
  virtual Spectrum power(const SceneObject&, const Wavelengths&) const = 0;

  /// For luminaires at infinity: samples a direction towards the light, and the pdf [1/sr] of a given direction. Implemented by
  /// emissions whose `knows_incident` returns true; others return pdf 0, and the sphere of directions is sampled uniformly.
  virtual DirectionSample sample_incident(Point2) const { return {}; }
  virtual float incident_pdf(const Vector3&) const { return 0; }
  virtual bool knows_incident() const { return false; }
  /// Whether the emission may be used at infinity only: its radiance depends on the direction, not on a point of a surface.
  virtual bool only_at_infinity() const { return false; }

  /// Called by Scene::prepare for every luminaire. The objects with this emission may have been replaced or prepared again:
  /// values cached about them must be dropped.
  virtual void objects_changed() {}

  /// Whether the side of the surface that the direction is on emits. A point without a normal, on a delta light, emits in all
  /// directions.
  bool emits(const SurfacePoint& point, const Vector3& direction) const {
    if (sides == Sides::both || point.normal == Normal3{}) return true;
    return (dot(point.normal, direction) > 0) == (sides == Sides::front);
  }

  /// The inverse of `sample_incident`: the points of the unit square that it maps to this direction. 0: not implemented.
  virtual IncidentPlaces incident_places(const Vector3&) const { return {}; }
  /// The most that there are of any direction.
  virtual int most_incident_places() const { return 0; }

  Sides sides = Sides::front;
};

}  // namespace etendue
