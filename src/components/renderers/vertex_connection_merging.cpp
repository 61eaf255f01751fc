// Vertex connection and merging (Georgiev, Křivánek, Davidovič & Slusallek 2012, "Light transport simulation with vertex
// connection and merging"; Hachisuka, Pantaleoni & Jensen 2012, "A path space extension for robust light transport
// simulation"; in media with photon points as Křivánek et al. 2014, "Unifying points, beams, and paths").
//
// Bidirectional path tracing joins a subpath y_0, y_1, … from a luminaire and one z_0, z_1, … from the lens by a segment
// between two of their vertices; photon mapping joins them where a vertex of the one lies within r of a vertex of the other.
// Both make the same paths, so each sample is the sum over all strategies
//     sum_{s,t} w_{s,t} alpha_s c_{s,t} alpha_t     vertex connection (bidirectional_path_tracer.cpp)
//   + sum_t sum_p w_{p,t} alpha_p f(z_{t-1}, w_p) alpha_t / (n pi r^2)     vertex merging with photons p near z_{t-1}, of n
//                                                                          light subpaths (Georgiev et al. 2012, eq. 11),
// weighted among all of them (transport/bidirectional_weight.h). render/bidirectional.h has the sum. Merging finds caustics
// seen in mirrors, which connections cannot find, and has less variance where connections pass almost specular vertices.
// Elsewhere its weight is small, and the blur with it. r shrinks from step to step, so that the blur vanishes
// (transport/photons.h).
//
// The n light subpaths of a step have their own primary samples: they are independent of those that samples connect to.
//
// Where `guided`, the camera subpath samples directions from a guide, as in bidirectional path tracing; the weights of photons
// contain the guide's pdfs too.

#include "etendue/guiding/guided_directions.h"
#include "etendue/render/bidirectional.h"
#include "etendue/render/guided_process.h"
#include "etendue/render/photon_process.h"
#include "etendue/render/renderer.h"
#include "etendue/render/shrinking_bias.h"
#include "etendue/transport/renderer_members.h"

namespace etendue {

class VertexConnectionMerging final : public Renderer, public ShrinkingBias {
 public:
  int max_depth = 64;
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
  bool connecting = true, merging = true;
  std::int64_t photon_walks = 0, most_photons = 50'000'000;
  float radius = 2, alpha = 0.75f;
  bool guided = false;
  int memory = 512;

  static void describe(Description<VertexConnectionMerging>& d) {
    d.summary(
        "Bidirectional path tracing and progressive photon mapping, weighted by how well each does: for caustics, also in "
        "mirrors and under water, together with all other light.",
        "Georgiev et al. 2012; Hachisuka et al. 2012");
    d.group("Paths");
    describe_max_depth<&VertexConnectionMerging::max_depth>(d, stored_subpath_depth, range(1, longest_stored_subpath));
    describe_roulette_depth<&VertexConnectionMerging::roulette_depth>(d);
    describe_heuristic<&VertexConnectionMerging::heuristic>(d, when("connecting"));
    d.group("Strategies")
        .member<&VertexConnectionMerging::connecting>(
            "connecting", "",
            "whether vertices of both walks are connected; without, walks from the camera end at the first surface that is no "
            "mirror, and photons are all the light there: progressive photon mapping")
        .member<&VertexConnectionMerging::merging>(
            "merging", "", "whether photons near a vertex are merged with it; without: bidirectional path tracing");
    d.group("Photons");
    describe_photons<&VertexConnectionMerging::photon_walks, &VertexConnectionMerging::most_photons>(d);
    describe_shrinking_radius<&VertexConnectionMerging::radius, &VertexConnectionMerging::alpha>(d);
    d.group("Guide");
    describe_guide<&VertexConnectionMerging::guided, &VertexConnectionMerging::memory>(d);
  }

  bool splats() const override { return connecting; }
  PathClasses finds() const override {
    if (!connecting && !merging) return no_paths;
    PathClasses lost = subsurface_light | fluorescent_media;
    lost |= merging ? fluorescent_surfaces : delta_caustics_in_mirrors;
    if (!connecting) lost |= emitting_media;  // walks from the camera end at the first place that photons are looked for
    return all_paths & ~lost;
  }
  Expectation expectation() const override { return merging ? Expectation::consistent : Expectation::unbiased; }
  double bias_width(std::uint32_t step) const override { return merging ? std::sqrt(shrunk_area(step, double(alpha))) : 0; }
  Estimator estimator() const override { return merging ? Estimator::correlated : Estimator::independent; }
  std::uint32_t samples_per_step(std::uint32_t usual) const override {
    return merging ? 1 : guided ? LearnedGuide::samples_per_step(usual) : usual;
  }
  bool steps_depend() const override { return guided; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

class VertexConnectionMergingProcess final : public GuidedProcess<PhotonProcess> {
 public:
  VertexConnectionMergingProcess(const VertexConnectionMerging& r, const RenderContext& c)
      : GuidedProcess(r, c, r.guided ? std::optional(GuideSettings{}) : std::nullopt, r.memory, r.max_depth),
        settings_(r),
        estimator_{.max_depth = r.max_depth,
                   .roulette_depth = r.roulette_depth,
                   .heuristic = r.heuristic,
                   .weighted = r.connecting,
                   .strategies = {.next_event = r.connecting, .connections = r.connecting, .lens = r.connecting}},
        first_radius_(double(r.radius) * double(seen_pixel_width(c))) {}

  void prepare_step(Schedule& schedule, const Step& step) override {
    if (!settings_.merging) return;
    share(step);
    std::optional<GuidedDirections> directions;  // light subpaths need the guide's pdfs alone, for their weights
    if (guide()) directions.emplace(guide()->guide(), false);
    photons_ = make_photons(schedule, step,
                            {.walks = std::uint64_t(settings_.photon_walks),
                             .most = std::uint64_t(settings_.most_photons),
                             .limits = {settings_.max_depth - 1, settings_.roulette_depth, directions ? &*directions : nullptr},
                             .radius = first_radius_,
                             .shrinking = double(settings_.alpha),
                             .weighted = settings_.connecting ? &settings_.heuristic : nullptr});
  }

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    return bidirectional_radiance(context, *settings_.light_sampler, ray, sample, estimator_,
                                  settings_.merging ? &photons_ : nullptr, guide());
  }

  std::optional<ShownPhotons> photons(size_t most) const override {
    if (!settings_.merging) return {};
    return some_of({&photons_}, most);
  }

 private:
  const VertexConnectionMerging& settings_;
  const BidirectionalSettings estimator_;
  const double first_radius_;  // [m]
  Photons photons_;
};

std::unique_ptr<RenderProcess> VertexConnectionMerging::begin(const RenderContext& context) const {
  return std::make_unique<VertexConnectionMergingProcess>(*this, context);
}

static const Register<VertexConnectionMerging> registered;

}  // namespace etendue
