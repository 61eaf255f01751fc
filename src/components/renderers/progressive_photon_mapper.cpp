// Progressive photon mapping (Hachisuka, Ogaki & Jensen 2008; Hachisuka & Jensen 2009, "Stochastic progressive photon mapping",
// in the form of Knaus & Zwicker 2011, "Progressive photon mapping: a probabilistic approach").
//
// A walk from the camera goes through mirrors and glass to the first vertex x that scatters smoothly. There, with T its
// throughput,
//     L = T [ L_e(x) + direct(x) + sum_p f(x, w, w_p) alpha_p / (n pi r^2) ],
// the sum being over photons p within r of x, of n walks from luminaires; in media f is the phase function and pi r^2 becomes
// 4/3 pi r^3 (transport/photons.h). Each step has new photons and a smaller r, so the mean over steps goes to the truth.
//
// Photons of caustics, light that mirrors and glass alone threw on, come from walks of their own that begin towards such
// objects (transport/emission_targets.h); the others leave those out.
//
// direct(x) is light straight from luminaires, found by sampling them and by going on from x to see whether one is met,
// weighted as in path tracing; photons then are those that were scattered before. A walk that has gone on for that sees
// luminaires alone: all else that comes to x is photons.

#include "etendue/render/photon_process.h"
#include "etendue/render/shrinking_bias.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/renderer_members.h"

namespace etendue {

class ProgressivePhotonMapper final : public Renderer, public ShrinkingBias {
 public:
  int max_depth = 64;
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
  bool next_event = true;
  std::int64_t photon_walks = 0, most_photons = 50'000'000;
  float radius = 4, alpha = 0.67f;

  static void describe(Description<ProgressivePhotonMapper>& d) {
    d.summary("Photons shared by all pixels within a radius that shrinks: for caustics, also in mirrors and under water.",
              "Hachisuka & Jensen 2009; Knaus & Zwicker 2011");
    d.group("Paths");
    describe_max_depth<&ProgressivePhotonMapper::max_depth>(d, kept_walk_depth, range(1, longest_kept_walk));
    describe_roulette_depth<&ProgressivePhotonMapper::roulette_depth>(d);
    d.member<&ProgressivePhotonMapper::next_event>(
        "next_event", "", "whether light straight from luminaires is sampled; without, it comes by photons as all other does");
    describe_heuristic<&ProgressivePhotonMapper::heuristic>(d, when("next_event"));
    d.group("Photons");
    describe_photons<&ProgressivePhotonMapper::photon_walks, &ProgressivePhotonMapper::most_photons>(d);
    describe_shrinking_radius<&ProgressivePhotonMapper::radius, &ProgressivePhotonMapper::alpha>(d);
  }

  PathClasses finds() const override { return all_paths & ~(subsurface_light | emitting_media); }
  Expectation expectation() const override { return Expectation::consistent; }
  double bias_width(std::uint32_t step) const override { return std::sqrt(shrunk_area(step, double(alpha))); }
  Estimator estimator() const override { return Estimator::correlated; }
  std::uint32_t samples_per_step(std::uint32_t) const override { return 1; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

class ProgressivePhotonProcess final : public PhotonProcess {
 public:
  ProgressivePhotonProcess(const ProgressivePhotonMapper& r, const RenderContext& c)
      : PhotonProcess(r, c), settings_(r), first_radius_(double(r.radius) * double(seen_pixel_width(c))), targets_(c.scene) {}

  void prepare_step(Schedule& schedule, const Step& step) override {
    share(step);
    Request request{.walks = std::uint64_t(settings_.photon_walks),
                    .most = std::uint64_t(settings_.most_photons),
                    .limits = {settings_.max_depth - 1, settings_.roulette_depth},
                    .fewest_vertices = settings_.next_event ? 2 : 1,
                    .radius = first_radius_,
                    .shrinking = double(settings_.alpha)};
    caustics_ = {};
    if (targets_.useful()) {
      request.kinds = PhotonKinds::no_caustics;
      Request caustics = request;
      caustics.kinds = PhotonKinds::caustics;
      caustics.targets = &targets_;
      caustics_ = make_photons(schedule, step, caustics);
    }
    photons_ = make_photons(schedule, step, request);
  }

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    CameraWalk walk(context.scene, sample, ray, settings_.max_depth);
    // Of a luminaire that the walk meets, against having sampled it.
    const auto met = [&](const SurfacePoint& luminaire) {
      if (walk.specular) return 1.0f;
      return heuristic_weight(
          settings_.heuristic, walk.direction_density,
          direct_light_density(*settings_.light_sampler, walk.from, walk.from_normal, walk.ray.direction, luminaire));
    };
    while (walk.next_vertex(met) && walk.specular && !walk.at_end()) {
      if (walk.vertex.scatters_smoothly()) gather(walk);
      const NumberStream::Bounce u = walk.next_bounce();
      if (settings_.next_event) walk.add_direct(*settings_.light_sampler, u, settings_.heuristic);
      if (walk.scatter(u) && !settings_.next_event && !walk.specular) walk.end();
    }
    return walk.radiance;
  }

 private:
  template <class Walk>
  void gather(Walk& walk) const {
    const auto add = [&](const Photon& p, float density) {
      if (walk.length + int(p.vertices) > settings_.max_depth) return;
      const Wavelengths& w = walk.sample.wavelengths;
      walk.add_light(int(p.vertices), scattered_from_photon(walk.vertex, p, w, w.single()) / density);
    };
    photons_.near(context.scene, walk.vertex, add);
    caustics_.near(context.scene, walk.vertex, add);
  }

  const ProgressivePhotonMapper& settings_;
  const double first_radius_;  // [m]
  const EmissionTargets targets_;
  Photons photons_, caustics_;
};

std::unique_ptr<RenderProcess> ProgressivePhotonMapper::begin(const RenderContext& context) const {
  return std::make_unique<ProgressivePhotonProcess>(*this, context);
}

static const Register<ProgressivePhotonMapper> registered;

}  // namespace etendue
