// Path tracing with next event estimation.
//
// Radiance along a ray is the sum over the vertices x_k of a random walk
//     L = sum_k T_k [ L_e(x_k) + direct(x_k) ],   T_{k+1} = T_k f |cos| / p,
// where at each x_k light is found in two ways: by sampling a luminaire (next event estimation), and by the walk itself
// meeting one. Both find the same light, so they are combined by multiple importance sampling; a walk that comes from a
// specular lobe can meet luminaires in the second way only and takes that in full (Kajiya 1986; Veach 1997, section 9).
// Russian roulette ends walks with a probability that keeps their expectation.
//
// At perfectly smooth glass the integral over directions is a sum of two, and with dispersion one for each wavelength: there a
// walk is divided, and its branches are walks of their own (transport/camera_walk.h, Splitting).
//
// In a medium the phase function takes the place of f |cos|. Weights compare the densities of directions alone, which is the
// same comparison whichever strategy made the path, so they add up to one.

#include "etendue/render/renderer.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/roulette.h"

namespace etendue {

class PathTracer final : public Renderer {
  int max_depth = 64;
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
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
    const bool clear = !context.scene.has_interiors() && !context.scene.has_null_surfaces();
    return clear ? follow(CameraWalk<true>(context.scene, sample, ray, max_depth))
                 : follow(CameraWalk<false>(context.scene, sample, ray, max_depth));
  }

 private:
  template <class Walk>
  [[gnu::noinline]] Spectrum follow_branch(Walk& branch) const {
    return follow(branch);
  }

  template <class Walk>
  [[gnu::always_inline]] Spectrum follow(Walk&& walk) const {
    const Roulette roulette{roulette_depth};
    const Splitting splitting{split_depth, split_wavelengths};
    // Of light that the walk meets, against having sampled it.
    const auto met = [&](const SurfacePoint& luminaire) {
      return next_event ? walk.emitter_hit_weight(*light_sampler, heuristic, luminaire) : 1.0f;
    };
    while (walk.next_vertex(met) && !walk.at_end()) {
      const NumberStream::Bounce u = walk.next_bounce();
      if (next_event) walk.add_direct(*light_sampler, u, heuristic);
      if (walk.splits(splitting))
        walk.split(splitting, u, [&](auto& branch) { return follow_branch(branch); });
      else if (walk.scatter(u) && !roulette.survives(walk))
        walk.end();
    }
    return walk.radiance;
  }
};

static const Register<PathTracer> registered;

}  // namespace etendue
