// Path tracing with specular manifold sampling (Zeltner, Georgiev & Jakob 2020, "Specular manifold sampling for rendering
// high-frequency caustics and glints").
//
// As in path tracing, radiance along a ray is the sum over the vertices x_k of a random walk
//     L = sum_k T_k [ w L_e(x_k) + direct(x_k) + chains(x_k) ],   T_{k+1} = T_k f |cos| / p,
// with emitter hits, next event estimation (path_tracer.cpp), and light that comes to x_k from a luminaire through a chain of
// mirrors and glass, for which next event estimation is blind: transport/manifold_sampling.h estimates it, with the weights
// by which each path counts once in all. For those the walk remembers how it left its last smooth vertex, and by which specular
// lobes it went on from there.

#include "etendue/render/renderer.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/manifold_sampling.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/roulette.h"

namespace etendue {

class ManifoldPathTracer final : public Renderer {
 public:
  int max_depth = 64;
  int roulette_depth = 5;
  int split_depth = 0, split_wavelengths = 3;

  static void describe(Description<ManifoldPathTracer>& d) {
    d.summary(
        "Path tracing that also searches the ways by which light of a luminaire comes to a surface or a medium through mirrors "
        "and smooth glass: for caustics, also those of small luminaires and of lights without extent, and those that are seen "
        "through glass. Light of an even sky, and light by chains that it cannot follow (through masks, thin panes and "
        "gratings, or totally reflected under interpolated or bumped normals), is found by chance, as in PathTracer; of lights "
        "without extent, which nothing meets by chance, what comes by such chains is lost.",
        "Zeltner, Georgiev & Jakob 2020, Specular manifold sampling for rendering high-frequency caustics and glints");
    d.group("Paths");
    describe_max_depth<&ManifoldPathTracer::max_depth>(d);
    describe_roulette_depth<&ManifoldPathTracer::roulette_depth>(d);
    d.member<&ManifoldPathTracer::heuristic>("heuristic", "",
                                             "how strategies that find the same light are weighted against each other",
                                             choices("balance", "power"));
    d.group("Chains")
        .member<&ManifoldPathTracer::chain_depth>(
            "chain_depth", "1",
            "longest chain, in mirrors and passages through boundaries: 2 for the light behind a glass ball",
            range(1, ChainLobes::longest))
        .member<&ManifoldPathTracer::unbiased>(
            "unbiased", "",
            "whether each chain is weighted by the number of searches until it is found again; if not, light of chains that "
            "all searches miss is lost, and there is less noise")
        .member<&ManifoldPathTracer::seeds>("seeds", "1", "searches at each place", range(1, 1000), soft(1, 64), logarithmic,
                                            unless("unbiased"));
    d.group("Smooth glass");
    describe_splitting<&ManifoldPathTracer::split_depth, &ManifoldPathTracer::split_wavelengths>(d);
  }

  /// Nothing meets a delta light by chance, so that only chains that are followed find it.
  PathClasses finds() const override {
    const bool whole = chain_depth >= std::min(max_depth - 2, ChainLobes::longest);
    return all_paths &
           ~(fluorescence | (whole ? PathClasses(delta_caustics_of_panes) : delta_caustics | delta_caustics_in_mirrors));
  }
  Expectation expectation() const override { return unbiased ? Expectation::unbiased : Expectation::biased; }

  Heuristic heuristic = Heuristic::power;
  int chain_depth = ChainLobes::longest;
  bool unbiased = true;
  int seeds = 16;

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

namespace {

/// How a camera path came from its last smooth vertex to where it is.
struct ChainBehind {
  bool begun = false;     ///< there is a smooth vertex
  bool followed = false;  ///< the specular vertices since then fit into `lobes`
  PathVertex receiver;    ///< the smooth vertex; its pointers to BSDF and media are not valid
  MediumStack around;     ///< media at it, on the side of `out`
  int length = 0;         ///< segments of the path up to it
  Ray ray;                ///< that left it
  MediumStack media;      ///< along the ray
  float pdf = 0;          ///< of the ray's direction [1/sr]
  Wavelengths wavelengths;
  ChainLobes lobes;  ///< of the vertices since then

  bool chain() const { return begun && followed && lobes.count > 0; }

  void add(Lobe lobe) {
    if (lobes.count == ChainLobes::longest) followed = false;
    if (followed) lobes.add(lobe);
  }
  /// For a branch, which may follow another wavelength than the hero of the path.
  ChainBehind with(Lobe lobe, const Wavelengths& of_branch) const {
    ChainBehind longer = *this;
    longer.add(lobe);
    longer.wavelengths = of_branch;
    return longer;
  }
  /// Before the walk leaves its last vertex, with the media of the segment that led there.
  template <class Walk>
  void at(const Walk& walk) {
    arrived = walk.media;
  }
  /// The walk has left its vertex by a sampled direction.
  template <class Walk>
  void left(const Walk& walk, const ScatterSample& next) {
    if (next.lobe == null_scattering) return;
    if (next.specular()) return add(next.lobe);
    begun = followed = true;
    lobes.count = 0;
    receiver = walk.vertex;
    around = arrived;
    length = walk.length;
    ray = walk.ray;
    media = walk.media;
    pdf = next.pdf;
    wavelengths = walk.sample.wavelengths;
  }

  MediumStack arrived;
};

class ManifoldProcess final : public RenderProcess {
 public:
  ManifoldProcess(const ManifoldPathTracer& r, const RenderContext& c)
      : RenderProcess(r, c),
        settings_(r),
        manifold_(c.scene, *r.light_sampler,
                  {.longest = r.chain_depth, .unbiased = r.unbiased, .seeds = r.seeds, .heuristic = r.heuristic}),
        unattenuated_(!c.scene.has_interiors() && !c.scene.has_null_surfaces()) {}

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    if (unattenuated_) {
      CameraWalk<true> walk(context.scene, sample, ray, settings_.max_depth);
      return follow(walk, {});
    }
    CameraWalk<false> walk(context.scene, sample, ray, settings_.max_depth);
    return follow(walk, {});
  }

 private:
  template <class Walk>
  Spectrum follow(Walk& walk, ChainBehind behind) const {
    const LightSampler& lights = *settings_.light_sampler;
    const Roulette roulette{settings_.roulette_depth};
    const Splitting splitting{settings_.split_depth, settings_.split_wavelengths};
    const auto met = [&](const SurfacePoint& luminaire) {
      return behind.chain() ? chain_hit_weight(walk, behind, luminaire)
                            : walk.emitter_hit_weight(lights, settings_.heuristic, luminaire);
    };
    while (walk.next_vertex(met) && !walk.at_end()) {
      const NumberStream::Bounce u = walk.next_bounce();
      walk.add_direct(lights, u, settings_.heuristic);
      add_chains(walk, behind.begun ? attempted : 1);
      if (walk.splits(splitting)) {
        const Vector3 out = walk.vertex.out;
        const Normal3 normal = walk.vertex.point.normal;
        walk.split(splitting, u,
                   [&](auto& branch) { return follow(branch, behind.with(specular_transmission, branch.sample.wavelengths)); });
        const bool reflected = (dot(normal, walk.ray.direction) > 0) == (dot(normal, out) > 0);
        behind.add(reflected ? specular_reflection : specular_transmission);
      } else if (const auto next = walk.sample_direction(u.lobe_choice, u.direction)) {
        behind.at(walk);
        if (!walk.go_on(*next)) continue;
        behind.left(walk, *next);
        if (!roulette.survives(walk)) walk.end();
      }
    }
    return walk.radiance;
  }

  /// The probability with which chains are searched at smooth vertices behind the first, whose light is blurred: a search costs
  /// more than many segments of a path.
  static constexpr float attempted = 0.25f;

  /// Light that comes to the last vertex through chains, which are searched with a probability.
  template <class Walk>
  void add_chains(Walk& walk, float probability) const {
    const int longest = settings_.max_depth - walk.length - 1;
    if (longest < 1 || !walk.vertex.scatters_smoothly() || !manifold_.useful()) return;
    NumberStream numbers = walk.numbers.fork("chains", std::uint32_t(walk.length));
    if (probability < 1 && numbers.next() >= probability) return;
    manifold_.sample(
        walk.vertex, walk.sample.wavelengths, longest, numbers, walk.sample.arena, [&] { return walk.sample.aborted(); },
        [&](const ChainLight& chain) {
          const Spectrum light = chain.light / probability;
          walk.add_light(chain.vertices + 1, light, chain.luminaire, chain.path, chain.in);
          walk.sample.sink.next_event(walk.throughput * light, walk.length + chain.vertices + 1, chain.weight);
        });
  }

  /// The weight of an emitter hit behind a chain, against manifold sampling.
  template <class Walk>
  [[gnu::noinline]] float chain_hit_weight(const Walk& walk, const ChainBehind& behind, const SurfacePoint& luminaire) const {
    if (!manifold_.useful()) return 1;
    PathVertex receiver = behind.receiver;
    if (receiver.media) receiver.media = receiver.point.media = &behind.around;
    receiver.scatter = nullptr;
    return manifold_.hit_weight(receiver, behind.ray, behind.media, behind.pdf, behind.lobes,
                                settings_.max_depth - behind.length - 1, luminaire, walk.ray.direction, behind.wavelengths,
                                walk.numbers.fork("chain hit", std::uint32_t(walk.length)), walk.sample.arena);
  }

  const ManifoldPathTracer& settings_;
  const ManifoldSampler manifold_;
  const bool unattenuated_;
};

}  // namespace

std::unique_ptr<RenderProcess> ManifoldPathTracer::begin(const RenderContext& context) const {
  return std::make_unique<ManifoldProcess>(*this, context);
}

static const Register<ManifoldPathTracer> registered;

}  // namespace etendue
