// Vertex connection and merging with a fault, built from the same parts as VertexConnectionMerging.

#include "etendue/render/photon_process.h"
#include "etendue/render/shrinking_bias.h"
#include "etendue/transport/bidirectional_subpaths.h"
#include "faults.h"

namespace etendue {
namespace {

class FaultyMerger final : public Renderer, public ShrinkingBias {
 public:
  Fault fault = Fault::none;
  int max_depth = 64;
  static constexpr double alpha = 0.75;

  static void describe(Description<FaultyMerger>& d) {
    d.summary("For tests: vertex connection and merging with something wrong.")
        .member<&FaultyMerger::max_depth>("max_depth", "1", "segments of the longest path", range(1, 64));
    describe_fault<&FaultyMerger::fault>(d);
  }
  bool splats() const override { return true; }
  PathClasses finds() const override { return all_paths & ~(subsurface_light | fluorescence); }
  Expectation expectation() const override { return Expectation::consistent; }
  double bias_width(std::uint32_t step) const override { return std::sqrt(shrunk_area(step, alpha)); }
  Estimator estimator() const override { return Estimator::correlated; }
  std::uint32_t samples_per_step(std::uint32_t) const override { return 1; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

class Process final : public PhotonProcess {
  const FaultyMerger& settings_;
  const double radius_;
  Photons photons_;

  struct Sum {
    const BidirectionalSubpaths& walks;
    SampleContext& sample;
    Spectrum radiance = {};
    void add(const std::optional<PathContribution>& light) {
      if (light) add_contribution(sample, walks.light_wavelengths(), *light, radiance);
    }
    void add(std::span<const PathContribution> all) {
      for (const PathContribution& light : all) add(std::optional(light));
    }
  };

 public:
  Process(const FaultyMerger& r, const RenderContext& c)
      : PhotonProcess(r, c), settings_(r), radius_(2 * double(seen_pixel_width(c))) {}

  void prepare_step(Schedule& schedule, const Step& step) override {
    static constexpr Heuristic heuristic = Heuristic::power;
    share(step);
    photons_ = make_photons(schedule, step,
                            {.most = 1'000'000,
                             .limits = {settings_.max_depth - 1, 5},
                             .radius = radius_,
                             .shrinking = FaultyMerger::alpha,
                             .weighted = &heuristic});
  }

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    const int max_depth = settings_.max_depth;
    const Fault fault = settings_.fault;
    BidirectionalSubpaths walks(context, *settings_.light_sampler, sample, {Heuristic::power, true, photons_.merging});
    Sum found{walks, sample};
    walks.from_camera(ray, {max_depth, 5});
    found.add(walks.segment_emission());
    walks.from_luminaire(ray.time, {max_depth - 1, 5});
    for (int t = 2; t <= walks.camera_vertices(); ++t) {
      found.add(walks.emitter_hits(t));
      const SubpathVertex& z = walks.camera_vertex(t);
      if (!z.connectable()) continue;
      photons_.near(context.scene, z, [&](const Photon& photon, float) {
        if (int(photon.vertices) + t - 1 > max_depth) return;
        std::optional<PathContribution> light = walks.merge(photon, t);
        if (light && fault == Fault::merging_unweighted) light->weight = 1;
        if (light && fault == Fault::kernel_not_shrunk)
          light->light *= float(photons_.merging.surface / (photons_.walks * M_PI * radius_ * radius_));
        found.add(light);
      });
      if (t <= max_depth) found.add(walks.next_event(t));
      for (int s = 2; s <= walks.light_vertices() && s + t - 1 <= max_depth; ++s)
        if (walks.light_vertex(s).connectable()) found.add(walks.connect(s, t));
    }
    for (int s = 2; s <= walks.light_vertices() && s <= max_depth; ++s)
      if (walks.light_vertex(s).connectable()) found.add(walks.connect_to_lens(s));
    return found.radiance;
  }
};

std::unique_ptr<RenderProcess> FaultyMerger::begin(const RenderContext& context) const {
  return std::make_unique<Process>(*this, context);
}

const Register<FaultyMerger> registered;

}  // namespace
}  // namespace etendue
