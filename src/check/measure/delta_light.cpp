#include "delta_light.h"

#include <algorithm>

#include "etendue/film/film.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/ray_tree.h"
#include "etendue/transport/visibility.h"

namespace etendue::measure {
namespace {

constexpr std::uint32_t samples = 1 << 13;

/// The mean over the picture of a meter at x is int p(w) L(w) dw with the pdf p of its directions [1/sr]. A delta light has
/// L(w) dw = L_e V / q, where L_e / q is its irradiance on a plane across the direction, as SceneObject::sample_visible gives
/// it (I / d^2 for a point), and V the transmittance.
Spectrum arriving(const Job& job, const SceneObject& luminaire, float time, const Wavelengths& wavelengths,
                  NumberStream& numbers, Arena& arena) {
  const Scene& scene = *job.scene;
  Ray ray = job.camera->ray({float(job.image->width) / 2, float(job.image->height) / 2}, {0.5f, 0.5f}, time);
  SurfaceSample light = luminaire.sample_visible(ray.origin, numbers.next_pair(), time);
  if (!(light.pdf > 0)) return {};
  ray.direction = light.direction;
  const float p = job.camera->pdf(ray).direction;
  const Spectrum emitted = luminaire.emission->radiance(light.point, -light.direction, wavelengths);
  if (!(p > 0) || emitted.black() || !scene.in_front(light.point, -light.direction)) return {};
  ray.maximum = infinity;
  if (!light.infinite) SurfacePoint::end_at(light.point, ray);
  MediumStack media;
  const MediumStack* around = media_around(scene, ray, media);
  return emitted * shadow_transmittance(scene, ray, around, wavelengths, numbers, arena) * (p / light.pdf);
}

}  // namespace

bool has_delta_light(const Job& job) {
  return std::ranges::any_of(job.scene->luminaires(), [](const SceneObject* luminaire) { return luminaire->delta(); });
}

Image delta_light(const Job& job, std::uint64_t seed) {
  Film film(*job.image);
  ImageTile tile;
  tile.begin(*job.image, {0, 0, 1, 1});
  Arena arena;
  for (std::uint32_t i = 0; i < samples; ++i) {
    const SampleKey key(seed, 0, 0, i);
    NumberStream numbers(*job.renderer->sampler, key);
    // Stratified: each render has one wavelength at random in each stratum, so that the spread of renders contains this error.
    const float u = (float(i) + numbers.next()) / float(samples);
    const Wavelengths wavelengths = job.wavelengths->sample(key, u);
    // The strata of times are another permutation, so that times and wavelengths are independent.
    const float time = job.camera->shutter_time((float(i * 1223 % samples) + numbers.next()) / float(samples));
    Spectrum light;
    for (const SceneObject* luminaire : job.scene->luminaires())
      if (luminaire->delta()) light += arriving(job, *luminaire, time, wavelengths, numbers, arena);
    tile.count_path();
    tile.contribute({0.5f, 0.5f}, 0, 0, i, light, wavelengths);
    arena.reset();
  }
  film.merge(tile);
  film.end_step();
  return film.develop();
}

}  // namespace etendue::measure
