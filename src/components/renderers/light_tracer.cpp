// Light tracing: paths that begin at the luminaires (Arvo 1986; Dutré, Lafortune & Willems 1993).
//
// A pixel is an integral of importance over all light that leaves luminaires. A light subpath y_0, y_1, … has the throughput
//     alpha = L_e |cos| / (P p_A p_w)  prod f |cos| / p,
// and each of its vertices is connected to the lens: with p_l the solid-angle pdf of a point of the lens as seen from the
// vertex,
//     alpha f |cos| V W_e / p_l
// is splatted where the camera images that direction. It is the strategy t = 1 of bidirectional path tracing alone, with the
// weight 1, and with y_0 too, where the camera sees a luminaire.

#include "etendue/render/bidirectional.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/renderer_members.h"

namespace etendue {

class LightTracer final : public Renderer {
  int max_depth = 64;
  int roulette_depth = 5;

 public:
  static void describe(Description<LightTracer>& d) {
    d.summary("Paths from the luminaires, connected to the lens at every vertex: best for caustics on what is seen directly.",
              "Arvo 1986, Backward ray tracing; Dutré, Lafortune & Willems 1993; Veach 1997, section 10.1");
    d.without("map_filter", "its paths come from luminaires, and what they meet is not averaged");
    d.group("Paths");
    describe_max_depth<&LightTracer::max_depth>(d, stored_subpath_depth, range(1, longest_stored_subpath));
    describe_roulette_depth<&LightTracer::roulette_depth>(d);
  }

  bool splats() const override { return true; }
  PathClasses finds() const override {
    return all_paths & ~(specular_views | seen_environments | delta_caustics_in_mirrors | emitting_media | subsurface_light);
  }

  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    return bidirectional_radiance(context, *light_sampler, ray, sample,
                                  {.max_depth = max_depth,
                                   .roulette_depth = roulette_depth,
                                   .weighted = false,
                                   .strategies = {.emitter_hits = false, .next_event = false, .connections = false}});
  }
};

static const Register<LightTracer> registered;

}  // namespace etendue
