// Vertex connection and merging (Georgiev, Křivánek, Davidovič & Slusallek 2012, "Light transport simulation with vertex
// connection and merging"; Hachisuka, Pantaleoni & Jensen 2012, "A path space extension for robust light transport
// simulation"; in media with photon points as Křivánek et al. 2014, "Unifying points, beams, and paths").
//
// Bidirectional path tracing joins a walk x_0, x_1, … from a luminaire and one z_0, z_1, … from the lens by a segment between
// two of their vertices; photon mapping joins them where a vertex of the one lies within r of a vertex of the other. Both make
// the same paths, so each sample adds, over all strategies,
//     sum_{s,t} w_{s,t} alpha_s c_{s,t} alpha_t     connections (BidirectionalPathTracer)
//   + sum_t sum_p w_{p,t} alpha_p f(z_{t-1}, w_p) alpha_t / (n pi r^2)     photons p near z_{t-1}, of n walks,
// with weights among all of them (transport/bidirectional_weight.h). Merging finds what connecting cannot, caustics seen in
// mirrors, and is better where connections pass almost specular vertices; where it is not, its weight is small, and the blur
// with it. r shrinks from step to step, so that what blur there is goes away (transport/photons.h).
//
// The n walks of a step have numbers of their own: they are independent of those that samples connect to.
//
// Where `guided`, the camera's walk learns where to go, as in bidirectional path tracing; weights of photons know of it, too.

#include "etendue/guiding/guided_directions.h"
#include "etendue/render/learned_guide.h"
#include "etendue/render/photon_process.h"
#include "etendue/render/shrinking_bias.h"
#include "etendue/transport/bidirectional_subpaths.h"
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
    PathClasses lost = subsurface_light;
    if (!merging) lost |= delta_caustics_in_mirrors;
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

class VertexConnectionMergingProcess final : public PhotonProcess {
 public:
  VertexConnectionMergingProcess(const VertexConnectionMerging& r, const RenderContext& c)
      : PhotonProcess(r, c), settings_(r), first_radius_(double(r.radius) * double(seen_pixel_width(c))) {
    if (r.guided) guide_.emplace(GuideSettings{}, size_t(r.memory) << 20);
  }

  void prepare_step(Schedule& schedule, const Step& step) override {
    if (!settings_.merging) return;
    share(step);
    std::optional<GuidedDirections> directions;  // of walks from luminaires nothing but densities is asked
    if (guide_) directions.emplace(guide_->guide(), false);
    photons_ = make_photons(schedule, step,
                            {.walks = std::uint64_t(settings_.photon_walks),
                             .most = std::uint64_t(settings_.most_photons),
                             .limits = {settings_.max_depth - 1, settings_.roulette_depth, directions ? &*directions : nullptr},
                             .radius = first_radius_,
                             .shrinking = double(settings_.alpha),
                             .weighted = settings_.connecting ? &settings_.heuristic : nullptr});
  }

  void step(Schedule& schedule, const Step& step) override {
    if (!guide_) return PhotonProcess::step(schedule, step);
    guide_->begin_step(context.image.sampled_area(), step, settings_.max_depth);
    guide_->learn(schedule, film_paths<GuideSample>(schedule, step));
  }
  std::optional<ShownLobes> lobes(const Point3& position, const Normal3& normal) const override {
    if (!guide_) return {};
    return guide_->lobes(position, normal);
  }
  std::vector<std::byte> save_state() const override { return guide_ ? guide_->save() : PhotonProcess::save_state(); }
  void load_state(std::span<const std::byte> bytes) override {
    if (guide_) guide_->load(bytes);
  }

  std::optional<ShownPhotons> photons(size_t most) const override {
    if (!settings_.merging) return {};
    return some_of({&photons_}, most);
  }

  Spectrum radiance(const Ray& camera_ray, SampleContext& sample) const override {
    const int max_depth = settings_.max_depth, roulette_depth = settings_.roulette_depth;
    const bool connecting = settings_.connecting, merges = settings_.merging;
    if (sample.observe.features) note_first_surface(context.scene, camera_ray, sample);
    BidirectionalSubpaths walks(context, *settings_.light_sampler, sample,
                                {settings_.heuristic, connecting, merges ? photons_.merging : Merging{}});
    Found found{walks, sample, connecting};
    const bool teaches = guide_ && guide_->teaches(sample);
    std::optional<GuidedDirections> directions;
    if (guide_) directions.emplace(guide_->guide(), teaches);
    found.teaches = teaches;
    walks.from_camera(camera_ray, {max_depth, roulette_depth, directions ? &*directions : nullptr}, found);
    if (connecting) walks.from_luminaire(camera_ray.time, {max_depth - 1, roulette_depth});

    for (int t = 2; t <= walks.camera_vertices() && !sample.aborted(); ++t) {
      if (!connecting && !walks.has_specular_prefix(t)) break;
      walks.meet(t, found);
      const SubpathVertex& z = walks.camera_vertex(t);
      if (!z.connectable()) continue;
      if (merges)
        photons_.near(context.scene, z, [&](const Photon& photon, float) {
          if (int(photon.vertices) + t - 1 <= max_depth) found.add(walks.merge(photon, t));
        });
      if (!connecting) continue;
      if (t <= max_depth) found.add(walks.sample_luminaire(t));
      for (int s = 2; s <= walks.light_vertices() && s + t - 1 <= max_depth && !sample.aborted(); ++s)
        if (walks.light_vertex(s).connectable()) found.add(walks.connect(s, t));
    }
    for (int s = 2; s <= walks.light_vertices() && s <= max_depth && !sample.aborted(); ++s)
      if (walks.light_vertex(s).connectable()) found.add(walks.connect_to_lens(s));
    if (teaches)
      for (const GuideSample& each : directions->learned(walks.camera_subpath(), found.arrived)) sample.record(each);
    walks.record();
    return found.radiance;
  }

 private:
  /// What one sample found.
  struct Found final : LightListener {
    const BidirectionalSubpaths& walks;
    SampleContext& sample;
    const bool connecting;
    bool teaches = false;
    Spectrum radiance;
    std::vector<Spectrum> arrived;  // by strategies of t vertices from the camera, if that teaches a guide

    Found(const BidirectionalSubpaths& w, SampleContext& at, bool connects) : walks(w), sample(at), connecting(connects) {}
    void found(const PathContribution& light) override {
      if (!connecting && !walks.has_specular_prefix(light.t)) return;
      add_contribution(sample, walks.light_wavelengths(), light, radiance);
      if (!teaches || light.t < 2) return;
      if (arrived.size() <= size_t(light.t)) arrived.resize(size_t(light.t) + 1);
      arrived[size_t(light.t)] += light.light * light.weight;
    }
    void add(const std::optional<PathContribution>& light) {
      if (light) found(*light);
    }
  };

  const VertexConnectionMerging& settings_;
  const double first_radius_;  // [m]
  Photons photons_;
  std::optional<LearnedGuide> guide_;
};

std::unique_ptr<RenderProcess> VertexConnectionMerging::begin(const RenderContext& context) const {
  return std::make_unique<VertexConnectionMergingProcess>(*this, context);
}

static const Register<VertexConnectionMerging> registered;

}  // namespace etendue
