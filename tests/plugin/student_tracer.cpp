// A path tracer with next event estimation, in one file, out of tree.
#include "etendue/render/renderer.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/renderer_members.h"

using namespace etendue;

class StudentTracer final : public Renderer {
  int max_depth = 16;

 public:
  static void describe(Description<StudentTracer>& d) {
    d.summary("Path tracing with next event estimation, as in a first course.", "Kajiya 1986");
    describe_max_depth<&StudentTracer::max_depth>(d);
  }

  PathClasses finds() const override { return all_paths & ~(delta_caustics | delta_caustics_in_mirrors | fluorescence); }

  // L = sum over the vertices x_k of a random walk of T_k (L_e(x_k) + direct light scattered at x_k).
  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    CameraWalk walk(context.scene, sample, ray, max_depth);
    // The weight of an emitter hit. After a specular vertex it is 1, since next event estimation cannot find such paths;
    // elsewhere both strategies find the same light and are combined by the balance heuristic.
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
    return walk.radiance;
  }
};

static const Register<StudentTracer> registered;
