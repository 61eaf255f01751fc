#pragma once
// GroupEmission: an EmissionShader whose radiance is that of the closures emission(), uniform_edf() and, of an object at
// infinity, background() that a group of shaders makes.

#include "etendue/emission_shader.h"
#include "group_run.h"

namespace etendue::osl {

// The shader may make the emission depend on the direction, by I. Directions are sampled in proportion to the cosine with the
// normal nevertheless, on the sides that emit. The power is the mean of radiance |cos| / pdf over points and directions of a
// regular pattern, as it only guides the choice among lights.
class GroupEmission : public EmissionShader, public RunsGroup {
 public:
  Spectrum radiance(const SurfacePoint&, const Vector3& direction, const Wavelengths&) const final;
  DirectionSample sample(const SurfacePoint&, Point2 u) const final;
  float pdf(const SurfacePoint&, const Vector3& direction) const final;
  Spectrum power(const SceneObject&, const Wavelengths&) const final;
};

}  // namespace etendue::osl
