// Path tracing of polarized light.
//
// Light is described by Stokes vectors (mueller.h), and what surfaces and media do to it by Mueller matrices. The rendering
// equation holds for them as for radiance, with a matrix in place of f, so the Stokes vector along a camera ray is
//     L = sum_k M_1 M_2 ... M_k [ E(x_k) + direct(x_k) ]
// over the vertices of a random walk (Wilkie, Tobler & Purgathofer 2001, "Combined rendering of polarization and fluorescence
// effects"; Jarabo & Arellano 2018, "Bidirectional rendering of vector light transport"). As matrices do not commute, the order
// of the product matters: the path meets first what light meets last, so new matrices are multiplied from the right, each
// turned to the reference direction of the one before. PolarizedWalk carries the product; all else is as in path_tracer.cpp.
//
// The picture is S0. The layer "stokes" of the image has S1, S2 and S3 relative to the camera: for light that arrives along the
// direction -d of a camera ray, the reference direction is x = d x up, horizontal in the picture. So the picture through a
// polarizing filter in front of the camera at the angle a, counter-clockwise from horizontal, is
//     (S0 + S1 cos 2a + S2 sin 2a) / 2.

#include "etendue/render/adaptive_lights.h"
#include "etendue/render/follows_polarization.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/polarized_walk.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/roulette.h"

namespace etendue {
namespace {

/// The vertical direction of the picture's middle, towards its upper edge, or near to it. Not normalized.
Vector3 up_in(const RenderContext& context, float time) {
  const float x = float(context.image.width) / 2, y = float(context.image.height) / 2, step = float(context.image.height) / 4;
  const Point2 lens{0.5f, 0.5f};
  const Ray above = context.camera.ray({x, y - step}, lens, time), below = context.camera.ray({x, y + step}, lens, time);
  const Vector3 turned = above.direction - below.direction;
  return length_squared(turned) > 1e-8f ? turned : above.origin - below.origin;  // parallel rays differ in their origins
}

/// The camera's reference direction for a ray.
Vector3 reference_direction(const RenderContext& context, const Ray& ray) {
  const Vector3 up = up_in(context, ray.time), across = cross(ray.direction, up);
  const float square = length_squared(across);
  return square > 1e-8f * length_squared(up) ? across / std::sqrt(square) : any_perpendicular(ray.direction);
}

class PolarizedPathTracer final : public Renderer, public FollowsPolarization {
  int max_depth = 64;
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::balance;
  bool next_event = true;

 public:
  static void describe(Description<PolarizedPathTracer>& d) {
    d.summary(
        "Path tracing of polarized light, with next event estimation, multiple importance sampling and Russian roulette. "
        "Mirrors, glass, metals, coats, filters and small particles polarize; luminaires and all other surfaces send out "
        "unpolarized light. The layer 'stokes' of the image has the state of polarization.",
        "Wilkie, Tobler & Purgathofer 2001, Combined rendering of polarization and fluorescence effects; Collett 2005, Field "
        "guide to polarization");
    describe_max_depth<&PolarizedPathTracer::max_depth>(d);
    describe_roulette_depth<&PolarizedPathTracer::roulette_depth>(d);
    describe_heuristic<&PolarizedPathTracer::heuristic>(d, when("next_event"));
    d.member<&PolarizedPathTracer::next_event>("next_event", "",
                                               "whether luminaires are sampled; without, paths must meet them by chance");
  }

  PathClasses finds() const override {
    const PathClasses lost = delta_caustics | delta_caustics_in_mirrors | fluorescence;
    return all_paths & ~(next_event ? lost : lost | delta_light);
  }
  bool follows_polarization() const override { return true; }
  bool keeps_stokes() const override { return true; }

  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    return radiance(context, *light_sampler, ray, sample);
  }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext& context) const override {
    return next_event ? adaptive_process(*this, context,
                                         [this, context](const LightSampler& lights, const Ray& ray, SampleContext& sample) {
                                           return radiance(context, lights, ray, sample);
                                         })
                      : Renderer::begin(context);
  }

  Spectrum radiance(const RenderContext& context, const LightSampler& lights, const Ray& ray, SampleContext& sample) const {
    PolarizedWalk walk(context.scene, sample, ray, max_depth, reference_direction(context, ray));
    const Roulette roulette{roulette_depth};
    const auto met = [&](const SurfacePoint& luminaire) {
      return next_event ? walk.emitter_hit_weight(lights, heuristic, luminaire) : 1.0f;
    };
    while (walk.next_vertex(met) && !walk.at_end()) {
      const NumberStream::Bounce u = walk.next_bounce();
      if (next_event) walk.add_direct(lights, u, heuristic);
      if (walk.scatter(u) && !roulette.survives(walk)) walk.end();
    }
    return walk.radiance;
  }
};

const Register<PolarizedPathTracer> registered;

}  // namespace
}  // namespace etendue
