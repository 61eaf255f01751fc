// Path tracing with next event estimation.
//
// Radiance along a ray is the sum over the vertices x_k of a random walk
//     L = sum_k T_k [ L_e(x_k) + direct(x_k) ],   T_{k+1} = T_k f |cos| / p,
// where light is found in two ways at each x_k: by sampling a luminaire (next event estimation), and by emitter hits of the
// walk. Both find the same light, so they are combined by multiple importance sampling; after a specular lobe only an emitter
// hit can find a luminaire, and counts in full (Kajiya 1986; Veach 1997, section 9). Russian roulette ends walks without
// changing the expectation.
//
// At perfectly smooth glass the integral over directions is a sum of reflection and refraction, and with dispersion refraction
// is a sum over the wavelengths: there a walk can be split into branches (transport/camera_walk.h, Splitting).
//
// Where a surface or the dye of a medium fluoresces, the walk may go on at other wavelengths (transport/fluorescence.h).
//
// In a medium the phase function takes the place of f |cos|. The weights compare the pdfs [1/sr] of directions alone, without
// transmittances. Both strategies compute the same weights for a path, so the weights add up to one.

#include "etendue/render/adaptive_lights.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/roulette.h"

namespace etendue {

class PathTracer final : public Renderer {
  int max_depth = 64;
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::balance;
  bool next_event = true;
  int split_depth = 0, split_wavelengths = 3;

 public:
  static void describe(Description<PathTracer>& d) {
    d.summary("Unidirectional path tracing with next event estimation, multiple importance sampling and Russian roulette.",
              "Kajiya 1986; Veach 1997, chapters 9 and 10");
    d.group("Paths");
    describe_max_depth<&PathTracer::max_depth>(d);
    describe_roulette_depth<&PathTracer::roulette_depth>(d);
    describe_heuristic<&PathTracer::heuristic>(d, when("next_event"));
    d.member<&PathTracer::next_event>("next_event", "",
                                      "whether luminaires are sampled; without, paths must meet them by chance");
    d.group("Smooth glass");
    describe_splitting<&PathTracer::split_depth, &PathTracer::split_wavelengths>(d);
  }

  PathClasses finds() const override {
    const PathClasses lost = delta_caustics | delta_caustics_in_mirrors;
    return all_paths & ~(next_event ? lost : lost | delta_light);
  }

  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    return radiance(context.scene, *light_sampler, ray, sample);
  }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext& context) const override {
    return next_event ? adaptive_process(
                            *this, context,
                            [this, &scene = context.scene](const LightSampler& lights, const Ray& ray, SampleContext& sample) {
                              return radiance(scene, lights, ray, sample);
                            })
                      : Renderer::begin(context);
  }

  Spectrum radiance(const Scene& scene, const LightSampler& lights, const Ray& ray, SampleContext& sample) const {
    const bool unattenuated = !scene.has_interiors() && !scene.has_null_surfaces() && !scene.has_fluorescence();
    return unattenuated ? follow(CameraWalk<true>(scene, sample, ray, max_depth), lights)
                        : follow(CameraWalk<false>(scene, sample, ray, max_depth), lights);
  }
  template <class Walk>
  [[gnu::noinline]] Spectrum follow_branch(Walk& branch, const LightSampler& lights) const {
    return follow(branch, lights);
  }

  template <class Walk>
  [[gnu::always_inline]] Spectrum follow(Walk&& walk, const LightSampler& lights) const {
    walk.reradiates = walk.reradiates_in_media = walk.scene.has_fluorescence();
    const Roulette roulette{roulette_depth};
    const Splitting splitting{split_depth, split_wavelengths};
    // The weight of an emitter hit against next event estimation.
    const auto met = [&](const SurfacePoint& luminaire) {
      return next_event ? walk.emitter_hit_weight(lights, heuristic, luminaire) : 1.0f;
    };
    while (walk.next_vertex(met) && !walk.at_end()) {
      const NumberStream::Bounce u = walk.next_bounce();
      if (next_event) walk.add_direct(lights, u, heuristic);
      if (walk.splits(splitting))
        walk.split(splitting, u, [&](auto& branch) { return follow_branch(branch, lights); });
      else if (walk.scatter(u) && !roulette.survives(walk))
        walk.end();
    }
    return walk.radiance;
  }
};

static const Register<PathTracer> registered;

}  // namespace etendue
