// Progressive photon mapping (Hachisuka, Ogaki & Jensen 2008; Hachisuka & Jensen 2009, "Stochastic progressive photon mapping",
// in the form of Knaus & Zwicker 2011, "Progressive photon mapping: a probabilistic approach").
//
// A camera subpath passes specular vertices up to its first vertex x that has smooth (non-delta) lobes. With T the throughput
// of the subpath,
//     L = T [ L_e(x) + direct(x) + sum_p f(x, w, w_p) alpha_p / (n pi r^2) ],
// where the sum is over the photons p within r of x, from n light subpaths (transport/photons.h). Each step has new photons and
// a smaller r, so the mean over steps converges to the true value.
//
// Radiance that media scatter towards the camera is estimated in one of three ways:
//     points       The subpath is scattered in media as well, and x may lie in one: then f is the phase function, and the
//                  volume 4/3 pi r^3 replaces pi r^2.
//     along_rays   Each camera ray gathers the photons within r of it (the beam radiance estimate: Jarosz, Zwicker & Jensen
//                  2008, "The beam radiance estimate for volumetric photon mapping"). With t_p the distance of photon p along
//                  the ray and T(t) the transmittance up to t,
//                      L = T sum_p T(t_p) phase(x_p, w, w_p) alpha_p / (n pi r^2).
//     beams        Each camera ray gathers the photon beams that pass it within r (render/photon_beams.h has the formula). The
//                  transmittance is then exact along both the ray and the beam, which needs homogeneous media; heterogeneous
//                  media are rendered as `along_rays`.
//
// Caustic photons, which arrive from the emitter by a specular chain, come from light subpaths of their own that start towards
// specular objects (transport/projection_map.h); the other light subpaths store no caustic photons.
//
// direct(x) is direct light, estimated by next event estimation and by emitter hits of the subpath continued from x, weighted
// as in path tracing; photons then carry only light that was scattered before. The continued subpath counts emitter hits alone,
// since photons represent all other light that arrives at x.

#include "etendue/render/photon_process.h"
#include "etendue/render/shrinking_bias.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/renderer_members.h"
#include "transport/medium_interval.h"

namespace etendue {

enum class InMedia : std::uint8_t { points, along_rays, beams };

class ProgressivePhotonMapper final : public Renderer, public ShrinkingBias {
 public:
  int max_depth = 64;
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
  bool next_event = true;
  std::int64_t photon_walks = 0, most_photons = 50'000'000;
  float radius = 4, alpha = 0.67f;
  InMedia media = InMedia::along_rays;
  std::int64_t beam_walks = 0, most_beams = 5'000'000;
  int split_depth = 0, split_wavelengths = 3;

  static void describe(Description<ProgressivePhotonMapper>& d) {
    d.summary("Photons shared by all pixels within a radius that shrinks: for caustics, also in mirrors and under water.",
              "Hachisuka & Jensen 2009; Knaus & Zwicker 2011");
    d.group("Paths");
    describe_max_depth<&ProgressivePhotonMapper::max_depth>(d, stored_subpath_depth, range(1, longest_stored_subpath));
    describe_roulette_depth<&ProgressivePhotonMapper::roulette_depth>(d);
    d.member<&ProgressivePhotonMapper::next_event>(
        "next_event", "", "whether light straight from luminaires is sampled; without, it comes by photons as all other does");
    describe_heuristic<&ProgressivePhotonMapper::heuristic>(d, when("next_event"));
    d.group("Photons");
    describe_photons<&ProgressivePhotonMapper::photon_walks, &ProgressivePhotonMapper::most_photons>(d);
    describe_shrinking_radius<&ProgressivePhotonMapper::radius, &ProgressivePhotonMapper::alpha>(d);
    d.group("Media")
        .member<&ProgressivePhotonMapper::media>(
            "media", "",
            "how light in media is gathered: `points`: at places where they scatter it by chance, from photons; `along_rays`: "
            "all along a ray, from photons; `beams`: all along a ray, from whole ways of photons, through media that are the "
            "same everywhere, and along rays in others",
            choices("points", "along_rays", "beams"))
        .member<&ProgressivePhotonMapper::beam_walks>(
            "beam_walks", "1", "walks from luminaires in each step whose ways are beams; 0: one for every eighth pixel",
            range(0, 4e9), soft(0, 1e6))
        .member<&ProgressivePhotonMapper::most_beams>("most_beams", "1",
                                                      "about so many beams are kept in each step, which takes up to 800 bytes "
                                                      "for each while their tree is built; where there would be more, each "
                                                      "is kept with a chance",
                                                      range(1, 4e8), soft(1e4, 1e7), logarithmic);
    d.group("Smooth glass");
    describe_splitting<&ProgressivePhotonMapper::split_depth, &ProgressivePhotonMapper::split_wavelengths>(d);
  }

  PathClasses finds() const override { return all_paths & ~(subsurface_light | emitting_media | fluorescence); }
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
                    .fewest_in_media = settings_.next_event && settings_.media == InMedia::points ? 2 : 1,
                    .in_homogeneous_media = settings_.media != InMedia::beams,
                    .radius = first_radius_,
                    .shrinking = double(settings_.alpha)};
    photons_ = caustics_ = {};
    beams_ = caustic_beams_ = {};
    if (targets_.useful()) {
      request.kinds = PhotonKinds::no_caustics;
      Request caustics = request;
      caustics.kinds = PhotonKinds::caustics;
      caustics.targets = &targets_;
      make(schedule, step, caustics, caustics_, caustic_beams_);
    }
    make(schedule, step, request, photons_, beams_);
  }

  std::optional<ShownPhotons> photons(size_t most) const override { return some_of({&photons_, &caustics_}, most); }

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    CameraWalk walk(context.scene, sample, ray, settings_.max_depth);
    walk.attenuates_only = settings_.media != InMedia::points;
    return follow(walk);
  }

 private:
  void make(Schedule& schedule, const Step& step, Request request, Photons& photons, Beams& beams) const {
    photons = make_photons(schedule, step, request);
    if (settings_.media != InMedia::beams || !context.scene.has_interiors()) return;
    const ImageBuffer& image = context.image;
    request.walks = settings_.beam_walks > 0 ? std::uint64_t(settings_.beam_walks)
                                             : (std::uint64_t(image.width) * std::uint64_t(image.height) + 7) / 8;
    request.most = std::uint64_t(settings_.most_beams);
    beams = make_beams(schedule, step, request);
  }

  template <class Walk>
  Spectrum follow(Walk& walk) const {
    const Splitting splitting{settings_.split_depth, settings_.split_wavelengths};
    const Met<Walk> met{*this, walk};
    while (walk.next_vertex(met) && walk.arrived_specularly && !walk.at_end()) {
      if (walk.vertex.scatters_smoothly()) gather(walk);
      const NumberStream::Bounce u = walk.next_bounce();
      if (settings_.next_event) walk.add_direct(*settings_.light_sampler, u, settings_.heuristic);
      if (walk.splits(splitting))
        walk.split(splitting, u, [&](auto& branch) { return follow(branch); });
      else if (walk.scatter(u) && !settings_.next_event && !walk.arrived_specularly)
        walk.end();
    }
    return walk.radiance;
  }

  /// Receives the emitter hits and the medium intervals of a subpath.
  template <class Walk>
  struct Met {
    const ProgressivePhotonProcess& self;
    Walk& walk;

    /// The weight of an emitter hit against next event estimation.
    float operator()(const SurfacePoint& luminaire) const {
      return walk.emitter_hit_weight(*self.settings_.light_sampler, self.settings_.heuristic, luminaire);
    }
    /// A medium interval of length `reach`. After a smooth vertex none is gathered: photons there contain in-scattered light.
    void through(const Medium& medium, float reach) const {
      if (walk.attenuates_only && walk.arrived_specularly) self.gather_along(walk, medium, reach);
    }
  };

  template <class Walk>
  static GatheringWavelengths wavelengths_of(const Walk& walk) {
    const Wavelengths& w = walk.sample.wavelengths;
    return {w, w.single(), walk.lane(), walk.branches};
  }

  template <class Walk>
  void gather(Walk& walk) const {
    const GatheringWavelengths of_walk = wavelengths_of(walk);
    const auto add = [&](const Photon& p, float area) {
      if (walk.length + int(p.vertices) > settings_.max_depth) return;
      walk.add_light(int(p.vertices), scattered_from_photon(walk.vertex, p, of_walk) / area, p.from(context.scene), p.path(),
                     p.out);
    };
    photons_.near(context.scene, walk.vertex, add);
    caustics_.near(context.scene, walk.vertex, add);
  }

  template <class Walk>
  void gather_along(Walk& walk, const Medium& medium, float reach) const {
    const GatheringWavelengths of_walk = wavelengths_of(walk);
    NumberStream numbers = walk.numbers.fork("beam", std::uint32_t(walk.length));
    const Ray ray = walk.ray;
    const auto add = [&](const Photon& p, float t, float area) {
      if (walk.length + int(p.vertices) > settings_.max_depth) return;
      const float phase = medium.phase(ray(t), ray.time, -ray.direction, p.out);
      walk.add_light_in(
          medium, int(p.vertices),
          transmittance(medium, ray, t, of_walk.wavelengths, numbers) * in_wavelengths(p, of_walk) * (phase / area),
          p.from(context.scene), p.path());
    };
    photons_.along(context.scene, ray, reach, add);
    caustics_.along(context.scene, ray, reach, add);
    if (settings_.media != InMedia::beams || !medium.volume->homogeneous()) return;
    const MediumInterval there = medium_interval(medium, ray, reach);
    const Ray within = there.within(ray);
    // At the wavelengths of the step, which the beams have: the subpath may have dropped some.
    const VolumeCoefficients c = medium.coefficients(ray.origin, ray.time, wavelengths({}, 0));
    const auto add_beam = [&](const PhotonBeam& b, float s, float t, float width) {
      if (walk.length + int(b.vertices) > settings_.max_depth) return;
      const float phase = medium.phase(within(t), ray.time, -ray.direction, -b.direction);
      walk.add_light_in(medium, int(b.vertices), in_wavelengths(b.light(s, t, c), b.hero_only, of_walk) * (phase / width),
                        b.from(context.scene), b.path());
    };
    beams_.along(context.scene, medium, within, there.length(), numbers, add_beam);
    caustic_beams_.along(context.scene, medium, within, there.length(), numbers, add_beam);
  }

  const ProgressivePhotonMapper& settings_;
  const double first_radius_;  // [m]
  const ProjectionMap targets_;
  Photons photons_, caustics_;
  Beams beams_, caustic_beams_;
};

std::unique_ptr<RenderProcess> ProgressivePhotonMapper::begin(const RenderContext& context) const {
  return std::make_unique<ProgressivePhotonProcess>(*this, context);
}

static const Register<ProgressivePhotonMapper> registered;

}  // namespace etendue
