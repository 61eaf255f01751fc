// Bidirectional path tracing (Lafortune & Willems 1993; Veach & Guibas 1994; Veach 1997, chapter 10).
//
// For each sample one subpath y_0, y_1, … begins at a luminaire and one z_0, z_1, … at the lens. Every vertex of the one is
// connected to every vertex of the other: s vertices of the first and t of the second make a path of s + t - 1 segments, and
// the sample is the sum over all s and t of
//     C_{s,t} = w_{s,t} alpha_s c_{s,t} alpha_t     (Veach 1997, eq. 10.3),
// with alpha the throughputs of the subpaths, c the light that passes the connection (f |cos| V |cos| f / d^2 between two
// surfaces; cosines are absent in media, and V includes the transmittance of media), and w the multiple importance sampling
// weight of the strategy among all that can make the same path (transport/bidirectional_weight.h).
//   s = 0: the camera subpath hits an emitter.      s = 1: next event estimation at z_{t-1}.
//   t = 1: the light subpath is connected to the lens, and splatted where it falls on the film.
// render/bidirectional.h has the sum over strategies.
//
// Where `guided`, the camera subpath samples directions from a guide, which learns from the contributions of all strategies
// (render/guided_process.h). The pdfs of its directions are then those of the guide's mixture, in all weights.

#include "etendue/render/bidirectional.h"
#include "etendue/render/guided_process.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/renderer_members.h"

namespace etendue {

class BidirectionalPathTracer final : public Renderer {
  int max_depth = 64;
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
  int light_vertices = -1, camera_vertices = -1;
  bool weighted = true;
  bool guided = false;
  int memory = 512;

 public:
  static void describe(Description<BidirectionalPathTracer>& d) {
    d.summary("Paths from the luminaires and from the camera, connected in all ways and weighted by how well each does.",
              "Lafortune & Willems 1993; Veach & Guibas 1994; Veach 1997, chapter 10");
    d.group("Paths");
    describe_max_depth<&BidirectionalPathTracer::max_depth>(d, stored_subpath_depth, range(1, longest_stored_subpath));
    describe_roulette_depth<&BidirectionalPathTracer::roulette_depth>(d);
    describe_heuristic<&BidirectionalPathTracer::heuristic>(d, when("weighted"));
    d.group("Strategies")
        .member<&BidirectionalPathTracer::light_vertices>(
            "light_vertices", "1", "shows the strategies with this many vertices from the luminaire alone; -1: all",
            at_least(-1))
        .member<&BidirectionalPathTracer::camera_vertices>(
            "camera_vertices", "1", "shows the strategies with this many vertices from the camera alone; -1: all", at_least(-1))
        .member<&BidirectionalPathTracer::weighted>("weighted", "",
                                                    "whether strategies are weighted; without, each shows all light it finds");
    d.group("Guide");
    describe_guide<&BidirectionalPathTracer::guided, &BidirectionalPathTracer::memory>(d);
  }

  std::uint32_t samples_per_step(std::uint32_t usual) const override {
    return guided ? LearnedGuide::samples_per_step(usual) : usual;
  }
  bool steps_depend() const override { return guided; }

  bool splats() const override { return true; }
  PathClasses finds() const override {
    const bool all = light_vertices < 0 && camera_vertices < 0 && weighted;
    return all ? all_paths & ~(delta_caustics_in_mirrors | subsurface_light | fluorescent_media) : no_paths;
  }

 private:
  friend class BidirectionalProcess;
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

class BidirectionalProcess final : public GuidedProcess<ShownProcess> {
 public:
  BidirectionalProcess(const BidirectionalPathTracer& r, const RenderContext& c)
      : GuidedProcess(r, c, r.guided ? std::optional(GuideSettings{}) : std::nullopt, r.memory, r.max_depth),
        settings_{.max_depth = r.max_depth,
                  .roulette_depth = r.roulette_depth,
                  .heuristic = r.heuristic,
                  .weighted = r.weighted,
                  .light_vertices = r.light_vertices,
                  .camera_vertices = r.camera_vertices} {}

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    return bidirectional_radiance(context, *renderer.light_sampler, ray, sample, settings_, nullptr, guide());
  }

 private:
  const BidirectionalSettings settings_;
};

std::unique_ptr<RenderProcess> BidirectionalPathTracer::begin(const RenderContext& context) const {
  return std::make_unique<BidirectionalProcess>(*this, context);
}

static const Register<BidirectionalPathTracer> registered;

}  // namespace etendue
