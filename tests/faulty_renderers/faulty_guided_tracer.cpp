// A guided path tracer with a fault, built from the same parts as GuidedPathTracer. Its guide is the same mixture of lobes at
// all places, mostly upwards.

#include "etendue/guiding/lobe_mixture.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/roulette.h"
#include "faults.h"

namespace etendue {
namespace {

class FaultyGuidedTracer final : public Renderer {
  Fault fault = Fault::none;
  int max_depth = 64, roulette_depth = 5;
  SeenLobes guide_;

 public:
  static void describe(Description<FaultyGuidedTracer>& d) {
    d.summary("For tests: path guiding with something wrong.");
    describe_fault<&FaultyGuidedTracer::fault>(d);
    describe_max_depth<&FaultyGuidedTracer::max_depth>(d);
    describe_roulette_depth<&FaultyGuidedTracer::roulette_depth>(d);
  }
  FaultyGuidedTracer() {
    LobeMixture lobes;
    lobes.set({}, 0, {{0, 0, 1}, 0, 2, 0.8f});
    lobes.set({}, 1, {{0.6f, 0, -0.8f}, 0, 1, 0.2f});
    guide_ = SeenLobes(lobes, {});
  }
  PathClasses finds() const override { return all_paths & ~(delta_caustics | delta_caustics_in_mirrors | fluorescence); }

  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    CameraWalk<false> walk(context.scene, sample, ray, max_depth);
    const auto met = [&](const SurfacePoint& luminaire) {
      if (walk.arrived_specularly) return 1.0f;
      return heuristic_weight(
          Heuristic::power, walk.direction_pdf,
          next_event_direction_pdf(*light_sampler, walk.from, walk.from_normal, walk.ray.direction, luminaire));
    };
    while (walk.next_vertex(met) && !walk.at_end()) {
      const NumberStream::Bounce u = walk.numbers.next_bounce();
      const PathVertex& v = walk.vertex;
      const bool guided = v.scatters_smoothly();
      walk.add_direct(*light_sampler, u, Heuristic::power, [&](const Vector3& in) {
        ScatterValue f = scattering(v, v.out, in, Transport::radiance);
        f.pdf = mixed(in, f.pdf);
        return f;
      });
      std::optional<ScatterSample> next;
      if (guided && u.lobe_choice < share) {
        const Vector3 in = guide_.sample(u.lobe_choice / share, u.direction);
        next = scattered_towards(v, in, mixed(in, scattering_pdf(v, v.out, in, Transport::radiance)), Transport::radiance);
      } else {
        next = walk.sample_direction(guided ? (u.lobe_choice - share) / (1 - share) : u.lobe_choice, u.direction);
        if (next && guided && !next->specular()) {
          const float scatter = next->pdf;
          next->pdf = mixed(next->direction, scatter);
          next->weight *= scatter / next->pdf;
        } else if (next && guided) {
          next->weight /= 1 - share;
        }
      }
      if (next && walk.go_on(*next) && !Roulette{roulette_depth}.survives(walk)) walk.end();
    }
    return walk.radiance;
  }

 private:
  static constexpr float share = 0.4f;
  float mixed(const Vector3& in, float scatter) const {
    const float guide = guide_.pdf(in);
    return (fault == Fault::guide_pdf ? 0 : share * guide) + (1 - share) * scatter;
  }
};
const Register<FaultyGuidedTracer> registered;

}  // namespace
}  // namespace etendue
