// Photon mapping with final gathering (Jensen 1996, "Global illumination using photon maps"; Jensen 2001, "Realistic image
// synthesis using photon mapping").
//
// Let x be the first vertex of a camera subpath that has smooth (non-delta) lobes. The radiance that x scatters is split by the
// light's way from the emitter to x:
//     direct          next event estimation and emitter hits, weighted as in path tracing;
//     caustics        by a specular chain: the k photons of the caustic map nearest to x;
//     indirect        from another vertex y with smooth lobes: final gathering. The camera subpath continues from x to y, where
//                     the reflected radiance, direct light included, is that of the k photons of the global map nearest to y.
//                     Where y is nearer to x than the maximum photon distance, photons cannot resolve the two, and y takes the
//                     place of x.
// With r_k the distance of the k-th nearest of the photons of n light subpaths, the radiance estimate is
//     L = sum_p f alpha_p / (n pi r_k^2),        in media sum_p phase alpha_p / (n 4/3 pi r_k^3),
// where the k-th photon gives r_k and is not part of the sum (transport/photons.h).
//
// Directions of final gathering are sampled from the BSDF, with the pdf p_f, or from the photons near x (Jensen 1995,
// "Importance driven path tracing using the photon map"): the K nearest ones each have a cone of solid angle W around their
// direction, and cone k is chosen with the probability P_k = alpha_k / sum_j alpha_j. Photons are chosen with the probability q
// (`importance`), so the pdf of a direction is
//     p(w) = (1 - q) p_f(w) + q sum_k P_k [w in cone k] / W     [1/sr]
// (guiding/photon_directions.h), which also is the pdf in the weights of direct light. Specular lobes are sampled by the BSDF
// alone, with 1 - q times their probability. Without photons near x, q = 0.
//
// Final gathering is not used in media: at a vertex there, photons carry all light that was scattered before.

#include "etendue/guiding/photon_directions.h"
#include "etendue/render/photon_process.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/irradiance_points.h"
#include "etendue/transport/renderer_members.h"

namespace etendue {

class PhotonMapper final : public Renderer {
 public:
  int max_depth = 64;
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
  std::int64_t photon_walks = 0, caustic_walks = 0, most_photons = 50'000'000;
  int samples_per_map = 16, nearest = 60, nearest_caustic = 40;
  float farthest = 30, farthest_caustic = 6;
  bool final_gather = true, irradiance = false;
  float importance = 0;

  static void describe(Description<PhotonMapper>& d) {
    d.summary(
        "Photon maps, one for caustics and one for all other light, which is gathered from the first surface: quick and "
        "smooth, and blurred a little.",
        "Jensen 1996; Jensen 2001");
    d.group("Paths");
    describe_max_depth<&PhotonMapper::max_depth>(d, stored_subpath_depth, range(1, longest_stored_subpath));
    describe_roulette_depth<&PhotonMapper::roulette_depth>(d);
    describe_heuristic<&PhotonMapper::heuristic>(d);
    d.group("Photons");
    describe_photons<&PhotonMapper::photon_walks, &PhotonMapper::most_photons>(d);
    d.member<&PhotonMapper::caustic_walks>("caustic_walks", "1",
                                           "walks of each step towards mirrors and glass; 0: one for each pixel", range(0, 4e9),
                                           soft(0, 1e7))
        .member<&PhotonMapper::samples_per_map>("samples_per_map", "1",
                                                "samples of each pixel in a step, after which there are new photons",
                                                range(1, 65536), soft(1, 256), logarithmic)
        .member<&PhotonMapper::nearest>("nearest", "1", "photons of an estimate of the global map", range(2, 1e6),
                                        soft(10, 500), logarithmic)
        .member<&PhotonMapper::farthest>(
            "farthest", "1",
            "how far they may be, in widths of a pixel where it is first seen (the median over the "
            "picture)",
            more_than(0), soft(1, 100), logarithmic)
        .member<&PhotonMapper::nearest_caustic>("nearest_caustic", "1", "photons of an estimate of the caustic map",
                                                range(2, 1e6), soft(10, 500), logarithmic)
        .member<&PhotonMapper::farthest_caustic>("farthest_caustic", "1", "how far they may be, in the same widths",
                                                 more_than(0), soft(1, 100), logarithmic);
    d.group("Final gathering")
        .member<&PhotonMapper::final_gather>(
            "final_gather", "",
            "whether the walk goes on from the first smooth surface; without, the global map is seen directly")
        .member<&PhotonMapper::importance>("importance", "1",
                                           "share of gathering directions that are chosen by where photons came from",
                                           range(0, 0.95), when("final_gather"))
        .member<&PhotonMapper::irradiance>(
            "irradiance", "",
            "whether irradiance is found beforehand at every fourth photon, so that gathering looks at one in place of many; "
            "surfaces are taken for matt there (Christensen 1999)",
            when("final_gather"));
  }

  PathClasses finds() const override { return all_paths & ~(subsurface_light | emitting_media | fluorescence); }
  Expectation expectation() const override { return Expectation::biased; }
  Estimator estimator() const override { return Estimator::correlated; }
  std::uint32_t samples_per_step(std::uint32_t) const override { return std::uint32_t(samples_per_map); }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

class PhotonMapperProcess final : public PhotonProcess {
 public:
  PhotonMapperProcess(const PhotonMapper& r, const RenderContext& c)
      : PhotonProcess(r, c), settings_(r), pixel_(seen_pixel_width(c)), targets_(c.scene) {}

  void prepare_step(Schedule& schedule, const Step& step) override {
    share(step);
    Request request{.walks = std::uint64_t(settings_.photon_walks),
                    .most = std::uint64_t(settings_.most_photons),
                    .limits = {settings_.max_depth - 1, settings_.roulette_depth}};
    global_ = caustics_ = {};
    global_ = make_photons(schedule, step, request);
    request.walks = std::uint64_t(settings_.caustic_walks);
    request.kinds = PhotonKinds::caustics;
    if (targets_.useful()) request.targets = &targets_;
    caustics_ = make_photons(schedule, step, request);
    if (settings_.irradiance && settings_.final_gather) {
      const IrradiancePoints::Work work{context.scene, global_.map, size_t(settings_.nearest), settings_.farthest * pixel_,
                                        global_.walks, time(0)};
      irradiance_.build(work, schedule.collect<IrradiancePoints::Point>(work.items(), work));
    }
  }

  std::optional<ShownPhotons> photons(size_t most) const override { return some_of({&global_, &caustics_}, most); }

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    CameraWalk walk(context.scene, sample, ray, settings_.max_depth);
    enum class Seeks : std::uint8_t {
      all,         // only specular vertices so far: all emitter hits count
      gathered,    // after a smooth vertex: direct emitter hits, and light from other smooth vertices
      luminaires,  // direct emitter hits alone: photons contributed the other light
    } seeks = Seeks::all;
    const auto met = [&](const SurfacePoint& luminaire) {
      if (walk.arrived_specularly && seeks != Seeks::all) return 0.0f;
      return walk.emitter_hit_weight(*settings_.light_sampler, settings_.heuristic, luminaire);
    };
    while (walk.next_vertex(met) && seeks != Seeks::luminaires && !walk.at_end()) {
      const PathVertex& v = walk.vertex;
      const bool smooth = v.scatters_smoothly(), brought = v.in_medium() || !settings_.final_gather;
      if (smooth && seeks == Seeks::gathered && !brought && is_far(walk)) {
        add_all(walk);
        walk.end();
        continue;
      }
      if (smooth) add_photons(walk, caustics_, settings_.nearest_caustic, settings_.farthest_caustic, PhotonKinds::caustics);
      if (smooth && brought) add_photons(walk, global_, settings_.nearest, settings_.farthest, PhotonKinds::no_caustics);
      if (!go_on(walk, smooth && !brought)) walk.end();
      if (!walk.arrived_specularly) seeks = brought ? Seeks::luminaires : Seeks::gathered;
    }
    return walk.radiance;
  }

 private:
  /// Whether the last vertex is so far from the one before, where light is gathered, that photons can resolve the two.
  template <class Walk>
  bool is_far(const Walk& walk) const {
    return length_squared(walk.vertex.point.position - walk.from) > square(settings_.farthest * pixel_);
  }

  /// Adds the radiance estimate of the nearest photons: of caustics, of other indirect light, or of all light.
  template <class Walk>
  void add_photons(Walk& walk, const Photons& photons, int nearest, float farthest, PhotonKinds kinds) const {
    const PathVertex& v = walk.vertex;
    const Wavelengths& w = walk.sample.wavelengths;
    std::vector<PointTree::Near>& near = PointTree::near_on_this_thread();
    float radius = farthest * pixel_;
    photons.map.tree().nearest(v.point.position, radius, size_t(nearest), near);
    if (near.size() == size_t(nearest)) {
      radius = std::sqrt(near.front().squared);
      near.front().squared = infinity;  // the k-th photon gives r_k and is left out of the sum
    }
    const float place = v.in_medium() ? 4 * pi / 3 * radius * radius * radius : pi * square(radius);
    for (const PointTree::Near& each : near) {
      const Photon& p = photons.map[each.index];
      const bool wanted = kinds == PhotonKinds::all || (p.vertices > 1 && p.caustic == (kinds == PhotonKinds::caustics));
      if (!wanted || each.squared == infinity || walk.length + int(p.vertices) > settings_.max_depth) continue;
      if (p.in_medium != v.in_medium() || photon_occluded(context.scene, v, p, radius)) continue;
      walk.add_light(int(p.vertices), scattered_from_photon(v, p, {w, w.single()}) / (float(photons.walks) * place),
                     p.from(context.scene), p.path(), p.out);
    }
  }

  /// Adds the reflected radiance at a vertex that final gathering reached.
  template <class Walk>
  void add_all(Walk& walk) const {
    const PathVertex& v = walk.vertex;
    const Spectrum* irradiance = settings_.irradiance ? irradiance_.at(v) : nullptr;
    if (!irradiance) return add_photons(walk, global_, settings_.nearest, settings_.farthest, PhotonKinds::all);
    // The irradiance is taken to arrive along the normal; for a diffuse surface the direction makes no difference.
    const Vector3 normal = on_side(Vector3(v.point.normal), v.out);
    walk.add_light(1, v.scatter->evaluate(v.out, normal, {.lobes = v.lobes}) * *irradiance);
  }

  /// Adds next event estimation and samples the next direction, from the photons too if `guided` (final gathering).
  template <class Walk>
  bool go_on(Walk& walk, bool guided) const {
    const PathVertex& v = walk.vertex;
    const NumberStream::Bounce u = walk.next_bounce();
    const LightSampler& lights = *settings_.light_sampler;
    const float q = settings_.importance;
    std::optional<PhotonDirections> photons;
    if (guided && q > 0) photons.emplace(global_.map, v, settings_.farthest * pixel_);
    if (!photons || photons->empty()) {
      walk.add_direct(lights, u, settings_.heuristic);
      return walk.scatter(u);
    }
    const auto mixture = [&](const Vector3& in) {
      ScatterValue f = ScatteringOf{v}(in);
      f.pdf = (1 - q) * f.pdf + q * photons->pdf(in);
      return f;
    };
    walk.add_direct(lights, u, settings_.heuristic, mixture);
    NumberStream guide = walk.numbers.fork("photon", std::uint32_t(walk.length));
    if (guide.next() < q) {
      const Vector3 to = photons->sample(guide.next(), u.direction);
      const auto next = scattered_towards(v, to, mixture(to).pdf, Transport::radiance);
      return next && walk.go_on(*next);
    }
    std::optional<ScatterSample> next = walk.sample_direction(u.lobe_choice, u.direction);
    if (!next) return false;
    if (next->specular()) {
      next->weight /= 1 - q;
    } else {
      const float pdf = mixture(next->direction).pdf;
      next->weight *= next->pdf / pdf;
      next->pdf = pdf;
    }
    return walk.go_on(*next);
  }

  const PhotonMapper& settings_;
  const float pixel_;  // [m]
  const ProjectionMap targets_;
  Photons global_, caustics_;
  IrradiancePoints irradiance_;
};

std::unique_ptr<RenderProcess> PhotonMapper::begin(const RenderContext& context) const {
  return std::make_unique<PhotonMapperProcess>(*this, context);
}

static const Register<PhotonMapper> registered;

}  // namespace etendue
