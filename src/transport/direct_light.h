#pragma once
// Light that comes to a surface straight from luminaires.

#include "etendue/light_sampler.h"
#include "etendue/sampler.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "transport/multiple_importance.h"

namespace etendue {

/// Light that reaches a point unless something lies on the shadow ray.
struct DirectLight {
  Spectrum light;  ///< reflected radiance [W m^-2 sr^-1 nm^-1]
  Ray shadow;
};

/// One sample of direct light by choosing a point on a luminaire. With out = direction the path came from, in = direction
/// to the light, the reflected radiance is the integral over directions of f(out, in) L_e(in) V |cos(in)|. A luminaire is
/// chosen with probability P and a point on it with solid-angle density p(in), so the estimate is
///     w f L_e V |cos| / (P p),
/// with the multiple-importance weight w of P p against the density with which the shader itself gives `in`.
/// `shader_sampling` says whether that second strategy is used at all; if not, w = 1. `choice` picks the luminaire, `u` the
/// point on it. All but V is computed here; false: nothing can come, and `direct` is not to be looked at.
inline bool propose_direct_light(const LightSampler& lights, const SurfacePoint& point, const Scatter& scatter,
                                 const Vector3& out, const Wavelengths& wavelengths, float choice, Point2 u,
                                 Heuristic heuristic, DirectLight& direct, bool shader_sampling = true) {
  const LightChoice light = lights.choose(point.position, point.normal, choice);
  if (!light.luminaire) return false;
  const SurfaceSample s = light.luminaire->sample_visible(point.position, u, point.time);
  if (!(s.density > 0)) return false;
  const ScatterValue f = scatter.value_and_density(out, s.direction, Transport::radiance, smooth_lobes);
  if (f.value.black()) return false;
  const Spectrum emitted = light.luminaire->emission->radiance(s.point, -s.direction, wavelengths);
  if (emitted.black()) return false;
  if (s.infinite)
    point.leave(s.direction, direct.shadow);
  else
    point.towards(s.point.position, s.point.error, direct.shadow);
  const float density = light.probability * s.density;
  const float weight = weight_over_density(heuristic, density, s.delta || !shader_sampling ? 0 : f.density);
  direct.light = f.value * emitted * (scatter.cosine(s.direction) * weight);
  return true;
}

/// The solid-angle density [1/sr] with which the above would have given a point of a luminaire, seen from `from`.
inline float direct_light_density(const LightSampler& lights, const Point3& from, const Normal3& normal,
                                  const Vector3& direction, const SurfacePoint& on_luminaire) {
  const SceneObject& luminaire = *on_luminaire.object;
  const float probability = lights.probability(from, normal, luminaire);
  return probability > 0 ? probability * luminaire.visible_density(from, direction, on_luminaire) : 0;
}

}  // namespace etendue
