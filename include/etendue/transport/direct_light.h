#pragma once
// Light that comes to a vertex straight from luminaires.

#include "etendue/light_sampler.h"
#include "etendue/transport/multiple_importance.h"
#include "etendue/transport/path_vertex.h"

namespace etendue {

/// Light that reaches a point unless something lies on the shadow ray.
struct DirectLight {
  Spectrum light;  ///< scattered radiance [W m^-2 sr^-1 nm^-1]
  Ray shadow;
  float weight = 1;                        ///< of multiple importance sampling, which is part of `light`
  const SceneObject* luminaire = nullptr;  ///< that it comes from
};

/// One sample of direct light by choosing a point on a luminaire. The light scattered at a point is the integral over
/// directions of s(in) L_e(in) V, with s = f |cos| on a surface and the phase function in a medium. A luminaire is chosen
/// with probability P and a point on it with solid-angle density p(in), so the estimate is
///     w s L_e V / (P p),
/// with the multiple-importance weight w of P p against the density with which scattering itself gives `in`.
/// `scattering(in)` returns s [1/sr] and that density; 0 as density: that strategy is not used, w = 1. `choice` picks the
/// luminaire, `u` the point on it; `leave(sample, ray)` makes the ray from the point to the sampled one.
/// All but V is computed here; false: nothing can come, and `direct` is not to be looked at.
// Inlined whatever its size: a twentieth of the time of simple scenes.
template <class Scattering, class Leave>
[[gnu::always_inline]] inline bool sample_next_event_from(const Scene& scene, const LightSampler& lights, const Point3& from,
                                                          const Normal3& normal, float time, const Wavelengths& wavelengths,
                                                          float choice, Point2 u, Heuristic heuristic, DirectLight& direct,
                                                          const Scattering& scattering, const Leave& leave) {
  const LightChoice light = lights.choose(from, normal, choice);
  if (!light.luminaire) return false;
  SurfaceSample s = light.luminaire->sample_visible(from, u, time);
  if (!(s.pdf > 0)) return false;
  const ScatterValue f = scattering(s.direction);
  if (f.value.black()) return false;
  const Spectrum emitted = light.luminaire->emission->radiance(s.point, -s.direction, wavelengths);
  if (emitted.black() || !scene.in_front(s.point, -s.direction)) return false;
  leave(s, direct.shadow);
  const float pdf = light.probability * s.pdf;
  const float weight = weight_over_pdf(heuristic, pdf, s.delta ? 0 : f.pdf);
  direct.light = f.value * emitted * weight;
  direct.weight = weight * pdf;
  direct.luminaire = light.luminaire;
  return true;
}

/// What a vertex of a camera path scatters from a direction, and the density with which it sends the path there itself.
struct ScatteringOf {
  const PathVertex& vertex;
  [[gnu::always_inline]] ScatterValue operator()(const Vector3& in) const {
    return scattering(vertex, vertex.out, in, Transport::radiance);
  }
};

/// From a path's vertex. Light of a luminaire that scattering can meet as well is weighted against that: see
/// CameraWalk::add_direct.
template <class Scattering>
[[gnu::always_inline]] inline bool sample_next_event(const Scene& scene, const LightSampler& lights, const PathVertex& vertex,
                                                     float time, const Wavelengths& wavelengths, float choice, Point2 u,
                                                     Heuristic heuristic, DirectLight& direct, const Scattering& scattering) {
  return sample_next_event_from(scene, lights, vertex.point.position, vertex.normal(), time, wavelengths, choice, u, heuristic,
                                direct, scattering, [&](const SurfaceSample& s, Ray& ray) __attribute__((always_inline)) {
                                  ray.time = time;
                                  if (vertex.in_medium()) {
                                    ray.origin = vertex.point.position;
                                    ray.direction = s.direction;
                                    ray.maximum = infinity;
                                    if (!s.infinite) SurfacePoint::end_at(s.point, ray);
                                  } else if (s.infinite) {
                                    vertex.point.leave(s.direction, ray);
                                  } else {
                                    vertex.point.towards(s.point, ray);
                                  }
                                });
}

/// The solid-angle density [1/sr] with which the above would have given a point of a luminaire, seen from `from`.
inline float next_event_pdf(const LightSampler& lights, const Point3& from, const Normal3& normal, const Vector3& direction,
                            const SurfacePoint& on_luminaire) {
  const SceneObject& luminaire = *on_luminaire.object;
  const float probability = lights.probability(from, normal, luminaire);
  return probability > 0 ? probability * luminaire.visible_pdf(from, direction, on_luminaire) : 0;
}

}  // namespace etendue
