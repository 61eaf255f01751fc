#include "etendue/transport/connection.h"

#include "etendue/transport/visibility.h"

namespace etendue {
namespace {

/// L_e |cos| / (P p_A) of a point of a luminaire, the first vertex of a light subpath.
Spectrum emitted_towards(const SubpathVertex& y, const Vector3& direction, const Wavelengths& wavelengths) {
  return y.point.object->emission->radiance(y.point, direction, wavelengths) *
         (std::abs(dot(y.point.normal, direction)) / y.pdf_forward);
}

}  // namespace

std::optional<Connection> connect(const Scene& scene, const SubpathVertex& y, const SubpathVertex& z,
                                  const Wavelengths& wavelengths, NumberStream& numbers, Arena& arena) {
  const Vector3 d = y.point.position - z.point.position;
  const float squared = length_squared(d);
  if (!(squared > 0)) return {};
  Connection c;
  c.direction = d / std::sqrt(squared);
  const ScatterValue at_z = scattering(z, z.out, c.direction, Transport::radiance);
  if (at_z.value.black()) return {};
  const ScatterValue at_y = scattering(y, y.out, -c.direction, Transport::importance);
  c.light = y.throughput * at_y.value * at_z.value * z.throughput / squared;
  // If both subpaths have dropped wavelengths, both contain the factor spectrum_size, which must be applied once only.
  if (y.hero_only && z.hero_only) c.light /= float(spectrum_size);
  if (c.light.black()) return {};
  MediumStack scratch;
  Spectrum likely;
  const Spectrum visible = shadow_transmittance(scene, connecting_ray(z, y), media_towards(z, c.direction, scratch),
                                                wavelengths, numbers, arena, Transport::radiance, &likely);
  if (visible.black()) return {};
  c.light *= visible;
  c.pdf_at_z = at_z.pdf;
  c.pdf_at_y = at_y.pdf;
  c.mean_transmittance = likely.average();
  return c;
}

std::optional<LuminaireConnection> connect_to_luminaire(const Scene& scene, const LightSampler& lights, const SubpathVertex& z,
                                                        const Wavelengths& wavelengths, NumberStream& numbers, Arena& arena) {
  const float which = numbers.next();
  const Point2 u = numbers.next_pair();
  const LightChoice choice = lights.choose(z.point.position, z.normal(), which);
  if (!choice.luminaire) return {};
  SurfaceSample l = choice.luminaire->sample_visible(z.point.position, u, z.point.time);
  if (!(l.pdf > 0)) return {};
  const ScatterValue f = scattering(z, z.out, l.direction, Transport::radiance);
  if (f.value.black()) return {};
  const EmissionShader& emission = *choice.luminaire->emission;
  LuminaireConnection c;
  c.light = z.throughput * f.value * emission.radiance(l.point, -l.direction, wavelengths) / (choice.probability * l.pdf);
  if (c.light.black() || !scene.in_front(l.point, -l.direction)) return {};
  c.luminaire.kind = PathVertex::Kind::luminaire;
  c.luminaire.infinite = l.infinite;
  c.luminaire.point = l.point;
  c.direction = l.direction;
  c.delta = l.delta;
  MediumStack scratch;
  Spectrum likely;
  const Spectrum visible =
      shadow_transmittance(scene, l.infinite ? leaving_ray(z, l.direction) : connecting_ray(z, c.luminaire),
                           media_towards(z, l.direction, scratch), wavelengths, numbers, arena, Transport::radiance, &likely);
  if (visible.black()) return {};
  c.light *= visible;
  c.pdf_at_z = f.pdf;
  c.pdf_at_luminaire = l.infinite ? 1 : emission.pdf(l.point, -l.direction);
  c.mean_transmittance = likely.average();
  return c;
}

std::optional<LensConnection> connect_to_lens(const RenderContext& context, const SubpathVertex& y,
                                              const Wavelengths& wavelengths, NumberStream& numbers, Arena& arena) {
  const Camera& camera = context.camera;
  const bool emits = y.kind == PathVertex::Kind::luminaire;
  if (unseen(y)) return {};
  if (emits && (y.infinite || y.point.normal == Normal3{})) return {};  // a delta light has no image on the film
  const std::optional<LensSample> lens = camera.sample_lens(y.point.position, y.point.time, numbers.next_pair());
  if (!lens || !(lens->pdf > 0)) return {};
  LensConnection c;
  c.lens = *lens;
  if (SurfacePoint seen = y.point; emits && !context.scene.in_front(seen, lens->direction)) return {};
  const Spectrum sent = emits ? emitted_towards(y, lens->direction, wavelengths)
                              : y.throughput * scattered(y, y.out, lens->direction, Transport::importance);
  c.light = sent * (lens->importance / lens->pdf) * camera.lens_weight(*lens, wavelengths);
  if (c.light.black()) return {};
  const Ray ray_to_lens = lens_ray(y, *lens);
  MediumStack scratch;
  const MediumStack* media = media_towards(y, lens->direction, scratch);
  if (emits && media) {  // the stack of the vertex is for the side on which the subpath started
    media_at(context.scene, ray_to_lens.origin, ray_to_lens.time, scratch);
    media = &scratch;
  }
  Spectrum likely;
  const Spectrum visible =
      shadow_transmittance(context.scene, ray_to_lens, media, wavelengths, numbers, arena, Transport::importance, &likely);
  if (visible.black()) return {};
  c.light *= visible;
  c.mean_transmittance = likely.average();
  return c;
}

}  // namespace etendue
