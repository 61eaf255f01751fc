// A path tracer whose radiance is multiplied by a factor slightly above 1.

#include "etendue/render/renderer.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/renderer_members.h"

namespace etendue {
namespace {

class ScaledPathTracer final : public Renderer {
  float factor = 1.01f;
  int max_depth = 16;

 public:
  static void describe(Description<ScaledPathTracer>& d) {
    d.summary("For tests: path tracing, times a factor.")
        .member<&ScaledPathTracer::factor>("factor", "1", "what all light is multiplied by", range(0, 100));
    describe_max_depth<&ScaledPathTracer::max_depth>(d);
  }
  PathClasses finds() const override { return all_paths & ~(delta_caustics | delta_caustics_in_mirrors | fluorescence); }

  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    CameraWalk walk(context.scene, sample, ray, max_depth);
    const auto weight = [&](const SurfacePoint& luminaire) {
      if (walk.arrived_specularly) return 1.0f;
      const float sampled =
          next_event_direction_pdf(*light_sampler, walk.from, walk.from_normal, walk.ray.direction, luminaire);
      return walk.direction_pdf / (walk.direction_pdf + sampled);
    };
    while (walk.next_vertex(weight) && !walk.at_end()) {
      const NumberStream::Bounce u = walk.next_bounce();
      walk.add_direct(*light_sampler, u, Heuristic::balance);
      walk.scatter(u);
    }
    return factor * walk.radiance;
  }
};
const Register<ScaledPathTracer> registered;

}  // namespace
}  // namespace etendue
