// Bidirectional path tracing (Lafortune & Willems 1993; Veach & Guibas 1994; Veach 1997, chapter 10).
//
// For each sample one walk x_0, x_1, … begins at a luminaire and one z_0, z_1, … at the lens. Every vertex of the one
// is connected to every vertex of the other: s vertices of the first and t of the second make a path of s + t - 1 segments,
// whose estimate is
//     C_{s,t} = w_{s,t} alpha_s c_{s,t} alpha_t,
// with alpha the walks' throughputs, c the light that passes the connection (f |cos| V |cos| f / d^2 between two surfaces;
// cosines are absent in media, and V includes what media let through) and w the multiple-importance weight of the
// strategy among all that could have made the same path (transport/bidirectional_weight.h).
//   s = 0: the camera walk meets a luminaire.        s = 1: a luminaire is sampled as seen from z_{t-1}.
//   t = 1: a light walk goes to the lens, and the light falls on the film where it does.
//
// Where `guided`, the camera's walk learns where to go (guiding/guide.h; Vorba et al. 2014, "On-line learning of parametric
// mixture models for light transport simulation"), from what its own strategies bring to the picture. Densities of its
// directions are then those of the guide's mixture, in all weights.

#include "etendue/guiding/guided_directions.h"
#include "etendue/render/learned_guide.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/bidirectional_subpaths.h"
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
    return all ? all_paths & ~(delta_caustics_in_mirrors | subsurface_light) : no_paths;
  }

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    return radiance(context, camera_ray, sample, nullptr);
  }

 private:
  friend class GuidedBidirectionalProcess;
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;

  /// `guide`: null where there is none.
  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample,
                    const LearnedGuide* guide) const {
    if (sample.observe.features) note_first_surface(context.scene, camera_ray, sample);
    const bool teaches = guide && guide->teaches(sample);
    std::optional<GuidedDirections> directions;
    if (guide) directions.emplace(guide->guide(), teaches);
    BidirectionalSubpaths walks(context, *light_sampler, sample, {heuristic, weighted});
    Found found{*this, sample, walks.light_wavelengths()};
    found.teaches = teaches;
    walks.from_camera(camera_ray, {max_depth, roulette_depth, directions ? &*directions : nullptr}, found);
    walks.from_luminaire(camera_ray.time, {max_depth - 1, roulette_depth});

    for (int t = 2; t <= walks.camera_vertices() && !sample.aborted(); ++t) {
      walks.meet(t, found);
      if (!walks.camera_vertex(t).connectable()) continue;
      if (shows(1, t) && t <= max_depth) found.add(walks.sample_luminaire(t));
      for (int s = 2; s <= walks.light_vertices() && s + t - 1 <= max_depth && !sample.aborted(); ++s)
        if (shows(s, t) && walks.light_vertex(s).connectable()) found.add(walks.connect(s, t));
    }
    for (int s = 2; s <= walks.light_vertices() && s <= max_depth && !sample.aborted(); ++s)
      if (shows(s, 1) && walks.light_vertex(s).connectable()) found.add(walks.connect_to_lens(s));
    if (teaches)
      for (const GuideSample& each : directions->learned(walks.camera_subpath(), found.arrived)) sample.record(each);
    walks.record();
    return found.radiance;
  }

  /// What one sample found.
  struct Found final : LightListener {
    const BidirectionalPathTracer& self;
    SampleContext& sample;
    const Wavelengths& light_wavelengths;
    Spectrum radiance;
    bool teaches = false;
    std::vector<Spectrum> arrived;  // by strategies of t vertices from the camera, if that teaches a guide

    Found(const BidirectionalPathTracer& renderer, SampleContext& at, const Wavelengths& w)
        : self(renderer), sample(at), light_wavelengths(w) {}
    void found(const PathContribution& light) override {
      if (!self.shows(light.s, light.t)) return;
      add_contribution(sample, light_wavelengths, light, radiance);
      if (!teaches || light.t < 2) return;
      if (arrived.size() <= size_t(light.t)) arrived.resize(size_t(light.t) + 1);
      arrived[size_t(light.t)] += light.light * light.weight;
    }
    void add(const std::optional<PathContribution>& light) {
      if (light) found(*light);
    }
  };

  bool shows(int s, int t) const {
    return (light_vertices < 0 || s == light_vertices) && (camera_vertices < 0 || t == camera_vertices);
  }
};

class GuidedBidirectionalProcess final : public RenderProcess, public ShownInSpace {
 public:
  GuidedBidirectionalProcess(const BidirectionalPathTracer& r, const RenderContext& c)
      : RenderProcess(r, c), settings_(r), guide_({}, size_t(r.memory) << 20) {}

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    return settings_.radiance(context, ray, sample, &guide_);
  }
  void step(Schedule& schedule, const Step& step) override {
    guide_.begin_step(context.image.sampled_area(), step, settings_.max_depth);
    guide_.learn(schedule, film_paths<GuideSample>(schedule, step));
  }
  std::optional<ShownLobes> lobes(const Point3& position, const Normal3& normal) const override {
    return guide_.lobes(position, normal);
  }
  std::vector<std::byte> save_state() const override { return guide_.save(); }
  void load_state(std::span<const std::byte> bytes) override { guide_.load(bytes); }

 private:
  const BidirectionalPathTracer& settings_;
  LearnedGuide guide_;
};

std::unique_ptr<RenderProcess> BidirectionalPathTracer::begin(const RenderContext& context) const {
  if (guided) return std::make_unique<GuidedBidirectionalProcess>(*this, context);
  return Renderer::begin(context);
}

static const Register<BidirectionalPathTracer> registered;

}  // namespace etendue
