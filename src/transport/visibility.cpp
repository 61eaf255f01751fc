#include "etendue/transport/visibility.h"

#include "etendue/transport/boundaries.h"
#include "etendue/transport/medium.h"
#include "etendue/transport/scattering.h"

namespace etendue {

namespace {

Spectrum transmittance_of_shadow_ray(const Scene& scene, const Ray& shadow, const MediumStack* around,
                                     const Wavelengths& wavelengths, NumberStream& numbers, Arena& arena, Transport transport,
                                     Spectrum* likely, NullCrossings* crossed) {
  MediumStack media;
  if (around) media = *around;
  Ray ray = shadow;
  const Point3 end = std::isfinite(ray.maximum) ? ray(ray.maximum) : Point3{};
  Spectrum fraction(1.0f);
  SurfacePoint point;
  for (int crossings = 0; crossings <= most_crossings; ++crossings) {
    const ArenaScope memory(arena);
    Hit hit;
    const bool found = scene.nearest(ray, hit);
    if (around)
      if (const Medium medium = medium_in(media)) {
        const float reach = found ? hit.distance : ray.maximum;
        fraction *= transmittance(medium, ray, reach, wavelengths, numbers);
        if (likely) *likely *= weighting_transmittance(medium, ray, reach, wavelengths);
        if (fraction.black()) return fraction;
      }
    if (!found) return fraction;

    if (!hit.object->shader) return {};
    if (around) {
      scene.locate(ray, hit, point);
      resolve_coincident(scene, ray, hit, point, media);
    }
    const SceneObject& object = around ? *point.object : *hit.object;
    if (!object.shader) return {};
    const bool hidden = around && hidden_by_priority(media, object);
    if (!hidden && !(object.shader->possible_lobes() & null_scattering)) return {};
    if (!around) scene.locate(ray, hit, point);
    if (!hidden) {
      point.media = around ? &media : nullptr;
      const Scatter* scatter = bound(*object.shader, point, wavelengths, arena);
      const auto straight = scatter ? scatter->sample(-ray.direction, 0, {}, {transport, null_scattering}) : std::nullopt;
      if (!straight) return {};
      // Requested alone, the lobe has probability 1, and its weight is the fraction that is let through.
      fraction *= straight->weight;
      if (likely) *likely *= straight->weight;
      if (crossed) crossed->crossed(*scatter, -ray.direction);
    }
    if (around) cross_boundary(media, object, point.normal, ray.direction);
    ray.origin = point.exit(ray.direction);
    if (std::isfinite(ray.maximum)) {
      // The ray is aimed again: from the shifted origin the old direction could hit the luminaire's own surface too early.
      const Vector3 rest = end - ray.origin;
      if (!(dot(rest, ray.direction) > 0)) return fraction;
      ray.maximum = length(rest);
      ray.direction = rest / ray.maximum;
    }
  }
  return {};
}

}  // namespace

Spectrum shadow_transmittance_slowly(const Scene& scene, const Ray& shadow, const MediumStack* around,
                                     const Wavelengths& wavelengths, NumberStream& numbers, Arena& arena, Transport transport,
                                     Spectrum* likely) {
  return transmittance_of_shadow_ray(scene, shadow, around, wavelengths, numbers, arena, transport, likely, nullptr);
}

Spectrum shadow_transmittance_slowly(const Scene& scene, const Ray& shadow, const MediumStack* around,
                                     const Wavelengths& wavelengths, NumberStream& numbers, Arena& arena,
                                     NullCrossings& crossings) {
  return transmittance_of_shadow_ray(scene, shadow, around, wavelengths, numbers, arena, Transport::radiance, nullptr,
                                     &crossings);
}

}  // namespace etendue
