#pragma once
// Next event estimation: a sample of the light that comes to a vertex directly from a point of a luminaire.
//
// The radiance scattered at the vertex is the integral over directions `in` of s(in) L_e(in) V(in), with s = f |cos| on a
// surface and the phase function in a medium, and the visibility V. A luminaire is chosen with probability P and a point on it
// with the pdf p(in) [1/sr], so the estimate is
//     w s L_e V / (P p),
// with the multiple importance sampling weight w of P p against the pdf p_s with which scattering samples `in`:
//     w = P p / (P p + p_s)     for the balance heuristic (multiple_importance.h).

#include "etendue/light_sampler.h"
#include "etendue/transport/multiple_importance.h"
#include "etendue/transport/path_vertex.h"

namespace etendue {

/// Unoccluded radiance: the shadow ray has not been traced yet.
struct DirectLight {
  Spectrum light;  ///< scattered radiance, weighted [W m^-2 sr^-1 nm^-1]
  Ray shadow;
  float weight = 1;                        ///< of multiple importance sampling; already included in `light`
  const SceneObject* luminaire = nullptr;  ///< the emitter
};

/// Samples one point on a luminaire and computes the estimate without V. `scattering(in)` returns s [1/sr] and the pdf p_s
/// [1/sr]; a pdf of 0 means that no emitter hits are added, w = 1. `choice` selects the luminaire, `u` the point on it;
/// `leave(sample, ray)` sets the shadow ray from the vertex to the sampled point. False: the contribution is 0, and `direct` is
/// not valid.
// Always inlined, whatever its size: this saves a twentieth of the time of simple scenes.
template <class Scattering, class Leave>
[[gnu::always_inline]] inline bool sample_next_event_from(const Scene& scene, const LightSampler& lights, const Point3& from,
                                                          const Normal3& normal, float time, const Wavelengths& wavelengths,
                                                          float choice, Point2 u, Heuristic heuristic, DirectLight& direct,
                                                          const Scattering& scattering, const Leave& leave) {
  const LightChoice light = lights.choose(from, normal, choice);
  if (!light.luminaire) return false;
  SurfaceSample sampled = lights.sample(*light.luminaire, from, normal, u, time);
  if (!(sampled.pdf > 0)) return false;
  const ScatterValue f = scattering(sampled.direction);
  if (f.value.black()) return false;
  const Spectrum emitted = light.luminaire->emission->radiance(sampled.point, -sampled.direction, wavelengths);
  if (emitted.black() || !scene.in_front(sampled.point, -sampled.direction)) return false;
  leave(sampled, direct.shadow);
  const float pdf = light.probability * sampled.pdf;
  const float weight = weight_over_pdf(heuristic, pdf, sampled.delta ? 0 : f.pdf);
  direct.light = f.value * emitted * weight;
  direct.weight = weight * pdf;
  direct.luminaire = light.luminaire;
  return true;
}

/// f |cos| at a vertex of a camera path, and the pdf with which the path itself samples the direction by scattering.
struct ScatteringOf {
  const PathVertex& vertex;
  [[gnu::always_inline]] ScatterValue operator()(const Vector3& in) const {
    return scattering(vertex, vertex.out, in, Transport::radiance);
  }
};

/// The same for a vertex of a path. Light of a luminaire that a scattered ray can hit is weighted against that strategy: see
/// CameraWalk::add_direct.
template <class Scattering>
[[gnu::always_inline]] inline bool sample_next_event(const Scene& scene, const LightSampler& lights, const PathVertex& vertex,
                                                     float time, const Wavelengths& wavelengths, float choice, Point2 u,
                                                     Heuristic heuristic, DirectLight& direct, const Scattering& scattering) {
  return sample_next_event_from(scene, lights, vertex.point.position, vertex.normal(), time, wavelengths, choice, u, heuristic,
                                direct, scattering, [&](const SurfaceSample& sampled, Ray& ray) __attribute__((always_inline)) {
                                  ray.time = time;
                                  if (vertex.in_medium()) {
                                    ray.origin = vertex.point.position;
                                    ray.direction = sampled.direction;
                                    ray.maximum = infinity;
                                    if (!sampled.infinite) SurfacePoint::end_at(sampled.point, ray);
                                  } else if (sampled.infinite) {
                                    vertex.point.leave(sampled.direction, ray);
                                  } else {
                                    vertex.point.towards(sampled.point, ray);
                                  }
                                });
}

/// The pdf [1/sr] with which next event estimation from `from` samples a given point of a luminaire: P p.
inline float next_event_direction_pdf(const LightSampler& lights, const Point3& from, const Normal3& normal,
                                      const Vector3& direction, const SurfacePoint& on_luminaire) {
  const SceneObject& luminaire = *on_luminaire.object;
  const float probability = lights.probability(from, normal, luminaire);
  return probability > 0 ? probability * lights.pdf(luminaire, from, normal, direction, on_luminaire) : 0;
}

}  // namespace etendue
