// A path tracer with a fault, built from the same parts as PathTracer.

#include "etendue/transport/direct_light.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/roulette.h"
#include "etendue/transport/visibility.h"
#include "etendue/transport/walk.h"
#include "faults.h"

namespace etendue {
namespace {

class FaultyPathTracer final : public Renderer {
  Fault fault = Fault::none;
  int max_depth = 64, roulette_depth = 5;

 public:
  static void describe(Description<FaultyPathTracer>& d) {
    d.summary("For tests: path tracing with something wrong.");
    describe_fault<&FaultyPathTracer::fault>(d);
    describe_max_depth<&FaultyPathTracer::max_depth>(d);
    describe_roulette_depth<&FaultyPathTracer::roulette_depth>(d);
  }
  PathClasses finds() const override {
    return all_paths & ~(delta_caustics | delta_caustics_in_mirrors | emitting_media | subsurface_light | fluorescence);
  }

  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    Spectrum radiance;
    const Transport transport = fault == Fault::no_squared_index ? Transport::importance : Transport::radiance;
    Walk<false> walk(context.scene, sample, ray, max_depth, transport);
    if (context.scene.has_interiors()) media_at(context.scene, ray.origin, ray.time, walk.media);
    const auto add = [&](int length, const Spectrum& light) {
      if (fault == Fault::skipped_length && length == 4) return;
      radiance += light;
      sample.sink.light(length, light);
    };
    while (walk.next_vertex()) {
      PathVertex& v = walk.vertex;
      if (v.kind == PathVertex::Kind::escape) {
        for (const SceneObject* far : context.scene.infinite_luminaires(walk.ray)) {
          far->surface_point(walk.ray, walk.hit, v.point);
          add(walk.length, met(walk));
        }
        break;
      }
      if (v.on_surface() && v.point.object->luminaire()) add(walk.length, met(walk));
      if (walk.length >= max_depth) break;
      const NumberStream::Bounce u = walk.numbers.next_bounce();
      DirectLight direct;
      if (v.scatters_smoothly() && sample_next_event(context.scene, *light_sampler, v, ray.time, sample.wavelengths,
                                                     u.light_choice, u.light_point, Heuristic::power, direct, ScatteringOf{v}))
        add(walk.length + 1, walk.throughput * arriving(walk, direct));
      const auto next = walk.sample_direction(u.lobe_choice, u.direction);
      if (!next) break;
      const bool in_medium = v.in_medium();
      walk.leave(*next);
      if (fault == Fault::phase_pdf && in_medium) walk.throughput *= next->pdf * (4 * pi);
      const Spectrum before = walk.throughput;
      if (!Roulette{roulette_depth}.survives(walk)) break;
      if (fault == Fault::roulette_undivided) walk.throughput = before;
    }
    return radiance;
  }

 private:
  Spectrum met(const Walk<false>& walk) const {
    const SurfacePoint& p = walk.vertex.point;
    const Spectrum light = walk.throughput * p.object->emission->radiance(p, -walk.ray.direction, walk.sample.wavelengths);
    if (walk.arrived_specularly || light.black() || fault == Fault::luminaire_twice) return light;
    const float weight =
        heuristic_weight(Heuristic::power, walk.direction_pdf,
                         next_event_direction_pdf(*light_sampler, walk.from, walk.from_normal, walk.ray.direction, p));
    return light * (fault == Fault::wrong_mis_weight ? std::sqrt(weight) : weight);
  }

  Spectrum arriving(Walk<false>& walk, const DirectLight& direct) const {
    MediumStack scratch;
    const PathVertex& v = walk.vertex;
    const Spectrum visible = shadow_transmittance(walk.scene, direct.shadow, media_towards(v, direct.shadow.direction, scratch),
                                                  walk.sample.wavelengths, walk.numbers, walk.sample.arena);
    Spectrum light = direct.light * visible;
    if (fault == Fault::transmittance_squared) light *= visible;
    if (fault == Fault::lost_cosine && v.on_surface()) light /= v.scatter->cosine(direct.shadow.direction);
    if (fault == Fault::wrong_measure && std::isfinite(direct.shadow.maximum)) light *= 1 / (1 + direct.shadow.maximum);
    return light;
  }
};
const Register<FaultyPathTracer> registered;

}  // namespace
}  // namespace etendue
