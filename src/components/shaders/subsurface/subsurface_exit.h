#pragma once
// The two ways in which the Subsurface shader finds where light leaves a body.

#include "etendue/sampler.h"
#include "etendue/scene.h"

namespace etendue {

/// What fills the body, at the point where light enters.
struct SubsurfaceBody {
  Spectrum returned;               ///< fraction of the light inside that leaves again, by a half space
  Spectrum mean_free_path;         ///< transport mean free path 1 / (s_a + s_s (1 - g)) [m]
  Spectrum single_albedo;          ///< s_s / (s_a + s_s); for the random walk
  float anisotropy = 0;            ///< g
  Spectrum eta = Spectrum(1.0f);   ///< index inside over index outside
  bool single_wavelength = false;  ///< the path has lost all but the hero
};

/// Where light that entered at a point leaves. `weight` is what it is multiplied by on its way, over the density of the
/// choice. False: it does not.
bool exit_by_diffusion(const SubsurfaceBody&, const SurfacePoint& entry, const Scene&, NumberStream&, SurfacePoint& exit,
                       Spectrum& weight);
bool exit_by_random_walk(const SubsurfaceBody&, const SurfacePoint& entry, const Scene&, NumberStream&, SurfacePoint& exit,
                         Spectrum& weight);

/// The nearest point at which a ray meets the surface of an object, through all others; the ray goes on from there.
inline bool next_on_object(const Scene& scene, const SceneObject* object, Ray& ray, SurfacePoint& point, float& distance) {
  constexpr int most = 64;  // surfaces of others in between
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
