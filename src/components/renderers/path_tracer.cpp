// Path tracing with next event estimation.
//
// Radiance along a ray is the sum over path lengths of
//     L = sum_k T_k [ L_e(x_k) + direct(x_k) ],   T_{k+1} = T_k f |cos| / p,
// where at each surface point x_k light is found in two ways: by sampling a luminaire (next event estimation), and by
// the path itself meeting one. Both find the same light, so they are combined by multiple importance sampling; a path
// that comes from a specular lobe can meet luminaires in the second way only and takes that in full (Kajiya 1986;
// Veach 1997, section 9). Russian roulette ends paths with a probability that keeps their expectation.
//
// In media a path may be scattered between surfaces: the distance is drawn by transport/media.h, T changes by the weight
// found there, and the phase function takes the place of f |cos|. Surfaces that light passes straight on are no vertices:
// the direction before them stays the one that was sampled. Weights compare the densities of directions alone, which is
// the same comparison whichever strategy made the path, so they add up to one.

#include "etendue/render/renderer.h"
#include "transport/direct_light.h"
#include "transport/media.h"
#include "transport/medium_tracking.h"
#include "transport/ray_steps.h"
#include "transport/record.h"
#include "transport/seeded_bug.h"
#include "transport/visibility.h"

namespace etendue {

class PathTracer final : public Renderer {
  int max_depth = 64;
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
  bool next_event = true;

 public:
  static void describe(Description<PathTracer>& d) {
    d.summary("Unidirectional path tracing with next event estimation, multiple importance sampling and Russian roulette.",
              "Kajiya 1986; Veach 1997, chapters 9 and 10")
        .member<&PathTracer::max_depth>("max_depth", "1",
                                        "longest path, in segments: 1 shows luminaires only, 2 adds direct light", at_least(1))
        .member<&PathTracer::roulette_depth>("roulette_depth", "1", "segments before Russian roulette may end a path",
                                             at_least(1))
        .member<&PathTracer::heuristic>("heuristic", "", "how the two ways of finding light are weighted",
                                        choices("balance", "power"))
        .member<&PathTracer::next_event>("next_event", "",
                                         "whether luminaires are sampled; without, paths must meet them by chance");
  }

  std::string limits() const override {
    return next_event ? "light that reaches a point only through specular surfaces from luminaires that paths cannot meet"
                      : "luminaires that paths cannot meet";
  }

  std::vector<Advice> misses(const SceneTraits& traits) const override {
    std::vector<Advice> advice;
    const std::vector<std::string> delta = delta_names(traits);
    if (delta.empty()) return advice;
    if (!next_event)
      advice.push_back({"light of " + some_of(delta) + " without next event estimation", "PathTracer { next_event: true }"});
    else if (!traits.specular.empty() && (!traits.smooth.empty() || !traits.media.empty()))
      advice.push_back(
          {"caustics of " + some_of(delta) + " by " + some_of(traits.specular), "BidirectionalPathTracer, LightTracer"});
    return advice;
  }

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    const bool clear = !context.scene.has_interiors() && !context.scene.has_null_surfaces();
    return clear ? trace<true>(context.scene, camera_ray, sample) : trace<false>(context.scene, camera_ray, sample);
  }

 private:
  /// `clear`: the scene has neither media nor boundaries that light passes through; what deals with them is left out.
  template <bool clear>
  Spectrum trace(const Scene& scene, const Ray& camera_ray, SampleContext& sample) const {
    const bool track_media = !clear && scene.has_interiors(), null_surfaces = !clear && scene.has_null_surfaces();
    MediumStack media;
    if (track_media) media_at(scene, camera_ray.origin, camera_ray.time, media);
    Spectrum radiance, throughput(1.0f);
    Ray ray = camera_ray;
    // How the current ray's direction was found: its solid-angle density [1/sr], and whether by a specular lobe.
    float direction_density = 0, eta_squared = 1;
    bool specular = true;
    Point3 from;
    Normal3 from_normal;
    float crossed = 0;  // distance to the last boundary passed straight on [m]
    int crossings = 0;  // of those since the last vertex

    const auto arrive = [&](int length, const Spectrum& light) __attribute__((always_inline)) {
      if (seeded(SeededBug::skipped_length) && length == 4) return;
      radiance += light;
      sample.note_length(length, light);
    };
    const auto meet = [&](const SurfacePoint& point, int length) __attribute__((always_inline)) {
      const Spectrum emitted = throughput * point.object->emission->radiance(point, -ray.direction, sample.wavelengths);
      float weight = 1;
      if (!specular && next_event && !emitted.black() && !seeded(SeededBug::luminaire_twice)) {
        const float light_density = direct_light_density(*light_sampler, from, from_normal, ray.direction, point);
        weight = heuristic_weight(heuristic, direction_density, light_density);
        if (seeded(SeededBug::wrong_mis_weight)) weight = std::sqrt(weight);
      }
      arrive(length, emitted * weight);
      record_emission(sample.record, emitted * weight, length, weight);
    };
    // Whether the path survives. The factor undoes the change of radiance by refraction, which comes back when the path
    // leaves the medium.
    const auto roulette = [&](int depth) __attribute__((always_inline)) {
      if (depth >= roulette_depth) {
        const float survival = std::min(1.0f, throughput.maximum() * eta_squared);
        if (sample.random.next() >= survival) return false;
        if (!seeded(SeededBug::roulette_undivided)) throughput /= survival;
      }
      return !throughput.black();
    };

    const bool one_luminaire = scene.luminaires().size() == 1;
    Hit hit;
    SurfacePoint point;
    DirectLight direct;
    bool awaits_light = false, goes_on = true;
    const Arena::Mark memory = sample.arena.mark();
    for (int depth = 1;; ++depth) {
      sample.arena.rewind(memory);                                 // of earlier vertices nothing is needed any more
      if ((depth & 62) == 0 && sample.aborted()) return radiance;  // twice in 64 segments: subsurface scattering takes two
      // The last vertex's shadow ray and the ray on from it need nothing of each other: the processor traces both at once.
      const bool lit = awaits_light && !(clear && scene.any(direct.shadow));
      const bool found = goes_on && scene.nearest(ray, hit);
      if (awaits_light) {  // whether it comes cannot be guessed, so nothing hangs on it
        const Spectrum came = lit ? direct.light : Spectrum();
        arrive(depth, came);
        if (sample.record && lit) record_direct(sample.record, direct.light, depth, direct.weight);
      }
      awaits_light = false;
      if (!goes_on) break;
      if (track_media)
        if (const VolumeShader* volume = volume_of(media)) {
          const float reach = found ? hit.distance : infinity;
          if (volume->emits()) arrive(depth, throughput * emitted_along(*volume, ray, reach, sample.wavelengths));
          const FreeFlight flight = sample_free_flight(*volume, ray, reach, throughput, sample.wavelengths, sample.random);
          throughput *= flight.weight;
          if (throughput.black()) break;
          if (flight.scattered) {
            if (depth >= max_depth) break;
            crossings = 0;
            ray.origin = ray(flight.distance);
            from = ray.origin;
            from_normal = {};
            record_volume(sample.record, from, throughput);
            awaits_light = next_event && light_in_volume(scene, *volume, ray, media, throughput, sample, direct);
            const Vector3 out = -ray.direction;
            ray.direction = volume->sample_phase(from, out, sample.random.next_pair(), direction_density);
            if (seeded(SeededBug::phase_density)) throughput *= direction_density * (4 * pi);
            specular = false;
            goes_on = roulette(depth);
            continue;
          }
        }
      if (!found) {
        for (const SceneObject* far : scene.infinite_luminaires()) {
          far->surface_point(ray, hit, point);
          record_escape(sample.record, *far, ray, throughput);
          meet(point, depth);
        }
        break;
      }
      const bool first = depth == 1 && sample.features, last = depth >= max_depth;
      // What the last segment meets matters only if it shines.
      if (clear && last && !first && !sample.record && hit.depth == 0 && !hit.object->luminaire()) break;
      scene.locate(ray, hit, point);
      if (track_media) {
        settle_coincident(scene, ray, hit, point, media);
        if (hidden_by_priority(media, *point.object)) {
          if (++crossings > most_crossings) break;
          crossed += hit.distance;
          cross_boundary(media, *point.object, point.normal, ray.direction);
          ray.origin = point.exit(ray.direction);
          ray.width = point.footprint;
          --depth;
          continue;
        }
        point.media = &media;
      }
      Vector3 out = -ray.direction;
      record_surface(sample.record, point, throughput);
      if (point.object->luminaire()) meet(point, depth);
      // Behind the last vertex a surface that light passes straight on may still show a luminaire.
      if (last && !first && !null_surfaces) break;

      const Scatter* scatter = scattering_at(point, out, sample.wavelengths, sample.arena);
      if (first && !(scatter && scatter->lobes() == pass_through))
        note_features(*sample.features, scene, point, hit, scatter, out, sample.wavelengths, crossed);
      if (!scatter || (last && !(null_surfaces && scatter->has(pass_through)))) break;

      std::optional<ScatterSample> next;
      for (bool moved = false;; moved = true) {
        const SampleStream::Bounce random = sample.random.next_bounce(!one_luminaire, scatter->has_choice());
        if (next_event && !last && scatter->has(smooth_lobes)) {
          awaits_light = propose_direct_light(*light_sampler, point, *scatter, out, sample.wavelengths, random.light_choice,
                                              random.light_point, heuristic, direct);
          if (awaits_light) {
            direct.light *= throughput;
            if (seeded(SeededBug::lost_cosine)) direct.light /= scatter->cosine(direct.shadow.direction);
            if (!clear) awaits_light = light_arrives(scene, point, out, media, sample, direct);
          }
        }

        const Transport transport = seeded(SeededBug::no_squared_index) ? Transport::importance : Transport::radiance;
        // Made where it stays: assigned it would be copied, which waits until its parts have reached memory.
        ::new (&next) std::optional<ScatterSample>(scatter->sample(out, random.lobe_choice, random.direction, transport));
        if (!next || moved || last || !enters_body(point, *next)) break;

        // Light that enters a body which scatters it leaves elsewhere: the path goes on from there. The way inside counts as
        // one segment.
        if (awaits_light && !(clear && scene.any(direct.shadow))) arrive(depth + 1, direct.light);
        awaits_light = false;
        throughput *= next->weight;
        if (next->dispersive) throughput *= sample.wavelengths.drop_secondary();
        record_scatter(sample.record, *next);
        next.reset();
        const std::optional<SubsurfaceExit> exit =
            point.object->shader->sample_exit(point, scene, sample.wavelengths, sample.random, sample.arena);
        if (!exit || !exit->scatter || ++depth >= max_depth) break;
        throughput *= exit->weight;
        // It leaves on the side it came in on.
        const bool front = dot(point.normal, out) > 0;
        point = exit->point;
        if (track_media) point.media = &media;
        scatter = exit->scatter;
        out = Vector3(front ? point.normal : -point.normal);
        record_surface(sample.record, point, throughput);
      }
      goes_on = false;
      if (!next || (last && next->lobe != pass_through)) continue;
      throughput *= next->weight;
      record_scatter(sample.record, *next);
      if (!clear && next->lobe == pass_through) {
        goes_on = !throughput.black() && ++crossings <= most_crossings;
        crossed += hit.distance;
        if (track_media) cross_boundary(media, *point.object, point.normal, next->direction);
        ray.origin = point.exit(ray.direction);
        ray.width = point.footprint;
        if (awaits_light) {
          arrive(depth + 1, direct.light);
          record_direct(sample.record, direct.light, depth + 1, direct.weight);
          awaits_light = false;
        }
        --depth;
        continue;
      }
      crossings = 0;
      eta_squared *= next->eta * next->eta;
      if (next->dispersive) throughput *= sample.wavelengths.drop_secondary();
      goes_on = roulette(depth);
      if (!goes_on) continue;

      if (track_media && next->transmitted()) cross_boundary(media, *point.object, point.normal, next->direction);
      from = point.position;
      from_normal = point.normal;
      direction_density = next->density;
      specular = next->specular();
      // Member by member: copying a ray just written stalls for its parts to reach memory.
      ray.origin = point.exit(next->direction);
      ray.direction = next->direction;
      ray.maximum = infinity;
      ray.width = point.footprint;
    }
    return radiance;
  }

  /// Light sampled from a point in a medium, with what the way to it lets through.
  bool light_in_volume(const Scene& scene, const VolumeShader& volume, const Ray& arriving, const MediumStack& media,
                       const Spectrum& throughput, SampleContext& sample, DirectLight& direct) const {
    const float choice = sample.random.next();
    if (!propose_direct_light(*light_sampler, volume, arriving.origin, -arriving.direction, arriving.time, sample.wavelengths,
                              choice, sample.random.next_pair(), heuristic, direct))
      return false;
    direct.light *= throughput * visible_fraction(scene, direct.shadow, &media, sample.wavelengths, sample.arena);
    return !direct.light.black();
  }

  /// Shadow rays through media and past surfaces that light passes straight on.
  static bool light_arrives(const Scene& scene, const SurfacePoint& point, const Vector3& out, const MediumStack& media,
                            SampleContext& sample, DirectLight& direct) {
    MediumStack around = media;
    const bool tracked = point.media != nullptr;
    // On the other side of the surface than the path came from, the object's inside begins or ends.
    const bool through = (dot(point.normal, out) > 0) != (dot(point.normal, direct.shadow.direction) > 0);
    if (tracked && through) cross_boundary(around, *point.object, point.normal, direct.shadow.direction);
    direct.light *= visible_fraction(scene, direct.shadow, tracked ? &around : nullptr, sample.wavelengths, sample.arena);
    return !direct.light.black();
  }
};

static const Register<PathTracer> registered;

}  // namespace etendue
