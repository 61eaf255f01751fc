// Path tracing with next event estimation.
//
// Radiance along a ray is the sum over path lengths of
//     L = sum_k T_k [ L_e(x_k) + direct(x_k) ],   T_{k+1} = T_k f |cos| / p,
// where at each surface point x_k light is found in two ways: by sampling a luminaire (next event estimation), and by
// the path itself meeting one. Both find the same light, so they are combined by multiple importance sampling; a path
// that comes from a specular lobe can meet luminaires in the second way only and takes that in full (Kajiya 1986;
// Veach 1997, section 9). Russian roulette ends paths with a probability that keeps their expectation.

#include "etendue/renderer.h"
#include "transport/direct_light.h"
#include "transport/medium_tracking.h"
#include "transport/record.h"

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

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    const Scene& scene = context.scene;
    const bool track_media = scene.has_interiors();
    MediumStack media;
    Spectrum radiance, throughput(1.0f);
    Ray ray = camera_ray;
    // How the current ray's direction was found: its solid-angle density [1/sr], and whether by a specular lobe.
    float direction_density = 0, eta_squared = 1;
    bool specular = true;
    Point3 from;
    Normal3 from_normal;

    const auto emitted_at = [&](const SurfacePoint& point) {
      const Vector3 out = -ray.direction;
      const Spectrum emitted = point.object->emission->radiance(point, out, sample.wavelengths);
      if (specular || !next_event || emitted.black()) return throughput * emitted;
      const float light_density = direct_light_density(*light_sampler, from, from_normal, ray.direction, point);
      return throughput * emitted * heuristic_weight(heuristic, direction_density, light_density);
    };

    const bool one_luminaire = scene.luminaires().size() == 1;
    Hit hit;
    SurfacePoint point;
    DirectLight direct;
    bool awaits_light = false, goes_on = true;
    for (int depth = 1;; ++depth) {
      // The last vertex's shadow ray and the ray on from it need nothing of each other: the processor traces both at once.
      const bool lit = awaits_light && !scene.any(direct.shadow);
      const bool found = goes_on && scene.nearest(ray, hit);
      if (lit) {
        radiance += direct.light;
        record_direct(sample.record, direct.light);
      }
      awaits_light = false;
      if (!goes_on) break;
      if (!found) {
        for (const SceneObject* far : scene.infinite_luminaires()) {
          far->surface_point(ray, hit, point);
          const Spectrum light = emitted_at(point);
          radiance += light;
          record_escape(sample.record, *far, ray, throughput, light);
        }
        break;
      }
      scene.locate(ray, hit, point);
      if (track_media) {
        if (hidden_by_priority(media, *point.object)) {
          cross_boundary(media, *point.object, point.normal, ray.direction);
          ray.origin = point.exit(ray.direction);
          --depth;
          continue;
        }
        point.media = &media;
      }
      const Vector3 out = -ray.direction;
      record_surface(sample.record, point, throughput);
      if (point.object->luminaire()) {
        const Spectrum light = emitted_at(point);
        radiance += light;
        record_emission(sample.record, light);
      }
      const bool first = depth == 1 && sample.features;
      if (depth >= max_depth && !first) break;

      const Scatter* scatter = scattering_at(point, out, sample);
      if (first) note_features(*sample.features, scene, point, hit, scatter, out, sample.wavelengths);
      if (!scatter || depth >= max_depth) break;

      // All of the bounce's numbers at once: they depend on nothing, so the processor finds them while it does the rest.
      SampleStream& random = sample.random;
      const float light_choice = one_luminaire ? (random.skip(), 0.0f) : random.next();
      const Point2 light_point = random.next_pair();
      const float lobe_choice = scatter->has_choice() ? random.next() : (random.skip(), 0.0f);
      const Point2 scatter_direction = random.next_pair();

      if (next_event && scatter->has(smooth_lobes)) {
        awaits_light = propose_direct_light(*light_sampler, point, *scatter, out, sample.wavelengths, light_choice, light_point,
                                            heuristic, direct);
        if (awaits_light) direct.light *= throughput;
      }

      goes_on = false;
      const std::optional<ScatterSample> next = scatter->sample(out, lobe_choice, scatter_direction);
      if (!next) continue;
      throughput *= next->weight;
      eta_squared *= next->eta * next->eta;
      if (next->dispersive) throughput *= sample.wavelengths.drop_secondary();
      record_scatter(sample.record, *next);

      // The factor undoes the change of radiance by refraction, which comes back when the path leaves the medium.
      if (depth >= roulette_depth) {
        const float survival = std::min(0.95f, throughput.maximum() * eta_squared);
        if (random.next() >= survival) continue;
        throughput /= survival;
      }
      if (throughput.black()) continue;
      goes_on = true;

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
      if (!specular) ray.spread = std::max(ray.spread, diffuse_spread);
    }
    return radiance;
  }

 private:
  /// Growth of the footprint after a rough reflection [per distance]: maps seen indirectly are filtered coarsely.
  static constexpr float diffuse_spread = 0.1f;

  const Scatter* scattering_at(const SurfacePoint& point, const Vector3& out, SampleContext& sample) const {
    const SceneObject& object = *point.object;
    if (!object.shader) return nullptr;
    if (object.sides != Sides::both && (dot(point.normal, out) > 0) != (object.sides == Sides::front)) return nullptr;
    return object.shader->bind(point, sample.wavelengths, sample.arena);
  }
};

static const Register<PathTracer> registered;

}  // namespace etendue
