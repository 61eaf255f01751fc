#pragma once
// The two methods by which the Subsurface shader finds where light leaves a body.

#include "etendue/sampler.h"
#include "etendue/scene.h"

namespace etendue {

/// The scattering parameters of the body, at the point where light enters.
struct SubsurfaceBody {
  Spectrum returned;               ///< albedo of a half space: fraction of the light let in that leaves again
  Spectrum mean_free_path;         ///< transport mean free path 1 / (s_a + s_s (1 - g)) [m]
  Spectrum single_albedo;          ///< s_s / (s_a + s_s); for the random walk
  float anisotropy = 0;            ///< g
  Spectrum eta = Spectrum(1.0f);   ///< index inside over index outside
  bool single_wavelength = false;  ///< only the path's hero wavelength is left
};

/// Samples the point where light that entered at `entry` leaves. `weight` is the throughput between the two over the pdf of the
/// choice. False: the light does not leave.
bool exit_by_diffusion(const SubsurfaceBody&, const SurfacePoint& entry, const Scene&, NumberStream&, SurfacePoint& exit,
                       Spectrum& weight);
bool exit_by_random_walk(const SubsurfaceBody&, const SurfacePoint& entry, const Scene&, NumberStream&, SurfacePoint& exit,
                         Spectrum& weight);

/// The nearest hit of a ray with the surface of `object`, through all other surfaces; the ray is moved on to start there.
inline bool next_on_object(const Scene& scene, const SceneObject* object, Ray& ray, SurfacePoint& point, float& distance) {
  constexpr int most = 64;  // hits, with the surfaces of other objects in between
  distance = 0;
  for (int i = 0; i < most; ++i) {
    Hit hit;
    if (!scene.nearest(ray, hit)) return false;
    scene.locate(ray, hit, point);
    distance += hit.distance;
    ray.maximum -= hit.distance;
    ray.origin = point.exit(ray.direction);
    if (point.object == object) return true;
    if (!(ray.maximum > 0)) return false;
  }
  return false;
}

}  // namespace etendue
