#include "media.h"

#include <vector>

#include "etendue/shader.h"
#include "medium_tracking.h"
#include "seeded_bug.h"

namespace etendue {
namespace {

/// exp(-s d) with 0 * infinity = 0: nothing is lost where nothing absorbs.
Spectrum exponential(const Spectrum& extinction, float distance) {
  return map(extinction, [distance](float s) { return s > 0 ? std::exp(-s * distance) : 1.0f; });
}

}  // namespace

Spectrum transmittance(const VolumeShader& volume, const Ray& ray, float distance, const Wavelengths& w) {
  const Spectrum t = exponential(volume.coefficients(ray.origin, ray.time, w).extinction(), distance);
  return seeded(SeededBug::transmittance_squared) ? t * t : t;
}

// For a homogeneous medium: int_0^d e exp(-s t) dt = e (1 - exp(-s d)) / s, and e d where s = 0.
Spectrum emitted_along(const VolumeShader& volume, const Ray& ray, float distance, const Wavelengths& w) {
  if (!volume.emits()) return {};
  const VolumeCoefficients c = volume.coefficients(ray.origin, ray.time, w);
  const Spectrum extinction = c.extinction();
  Spectrum light;
  for (int i = 0; i < spectrum_size; ++i) {
    const float s = extinction[i];
    light.set(i, c.emission[i] * (s > 0 ? -std::expm1(-s * distance) / s : distance));
  }
  return light;
}

FreeFlight sample_free_flight(const VolumeShader& volume, const Ray& ray, float reach, const Spectrum& throughput,
                              const Wavelengths& w, SampleStream& random) {
  const VolumeCoefficients c = volume.coefficients(ray.origin, ray.time, w);
  const Spectrum extinction = c.extinction();
  const float choice = random.next(), u = random.next();
  // Where nothing scatters, nothing is drawn.
  if (c.scattering.black()) return {false, reach, exponential(extinction, reach)};

  const float sum = throughput.average() * spectrum_size;
  const Spectrum weights = sum > 0 ? throughput / sum : Spectrum(1.0f / spectrum_size);
  int k = 0;
  for (float rest = choice - weights[0]; rest >= 0 && k + 1 < spectrum_size; rest -= weights[k]) ++k;
  while (k > 0 && !(weights[k] > 0)) --k;  // by rounding, behind the last that counts

  const float distance = extinction[k] > 0 ? -std::log1p(-u) / extinction[k] : infinity;
  const bool scattered = distance < reach;
  const Spectrum t = exponential(extinction, scattered ? distance : reach);
  const Spectrum densities = scattered ? extinction * t : t;
  float density = 0;
  for (int i = 0; i < spectrum_size; ++i) density += weights[i] * densities[i];
  if (!(density > 0)) return {false, reach, {}};
  return {scattered, scattered ? distance : reach, (scattered ? c.scattering * t : t) / density};
}

// A ray from the point to infinity crosses the surfaces of all objects around it. Walking the same way from outside,
// where there is nothing, to the point enters and leaves them as any path would.
void media_at_slowly(const Scene& scene, const Point3& p, float time, MediumStack& media) {
  struct Crossing {
    const SceneObject* object;
    Normal3 normal;
  };
  static thread_local std::vector<Crossing> crossings;
  crossings.clear();
  constexpr size_t most = 1000;

  Ray ray;
  ray.origin = p;
  ray.direction = normalize(Vector3{0.3713906f, 0.8571673f, 0.3565862f});
  ray.time = time;
  Hit hit;
  SurfacePoint point;
  while (crossings.size() < most && scene.nearest(ray, hit)) {
    scene.locate(ray, hit, point);
    crossings.push_back({point.object, point.normal});
    HitList others;
    Ray probe;
    coincident_hits(scene, ray, hit, point, probe, others);
    for (int i = 0; i < others.size; ++i) {
      scene.locate(probe, others.hits[i], point);
      crossings.push_back({point.object, point.normal});
    }
    if (others.size > 0) {
      scene.locate(ray, hit, point);
      point.error = std::max(point.error, length(probe.origin - point.position));
    }
    ray.origin = point.exit(ray.direction);
    hit = {};
  }
  for (size_t i = crossings.size(); i-- > 0;) {
    const SceneObject& object = *crossings[i].object;
    if (enterable(object)) cross_boundary(media, object, crossings[i].normal, -ray.direction);
  }
}

}  // namespace etendue
