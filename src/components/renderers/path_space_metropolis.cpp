// Metropolis light transport in path space (Veach & Guibas 1997; Veach 1997, chapter 11).
//
// A state is a whole path x (transport/light_path.h) with the contribution f(x) to the film; I(x) is the luminance of f(x).
// Mutations (transport/mutation.h), chosen in proportion to their shares, propose y with the pdf T(x -> y), and y is accepted
// with the probability
//     a = min(1, I(y) T(y -> x) / (I(x) T(x -> y))).
// With a probability p the proposal is an independent path instead. Its length k is chosen with the probability P(k), in
// proportion to 1 / k, and then how many of its vertices are sampled from the luminaire and how many from the lens. With D the
// mean of the pdfs of all these ways, the pdf of the path is
//     T(y) = P(k) D(y),
// and F = f / T is an estimate of the image by itself. States are weighted as in all Metropolis renderers here (StateWeights),
// in terms of F. Mirrors and clear surfaces are vertices of paths like others (transport/light_path.h).
//
// Brightness is measured by pairs of subpaths, with all paths y_j that a pair makes, as in bidirectional path tracing
// (PathSpace::all_ways). With their weights w_j, the expectation of sum w_j I(y_j) is the integral of I T, I being that of F.
// One of the y_j, chosen in proportion to its part of the sum and representing the whole sum, may be the first state of a chain
// (Veach 1997, section 11.3.1).
//
// Paths of one or two segments are estimated sample by sample, by a bidirectional path tracer.

#include "etendue/render/primary_sample_chains.h"
#include "etendue/transport/light_groups.h"
#include "etendue/transport/mutation.h"
#include "etendue/transport/renderer_members.h"

namespace etendue {

class PathSpaceMetropolis final : public Renderer {
 public:
  int max_depth = 64;
  std::vector<Ref<Mutation>> mutations;
  int mutations_per_sample = 4, chains = ChainSettings().chains;
  float bootstrap = ChainSettings().bootstrap, large_steps = 0.1f;
  bool even_errors = ChainSettings().even_errors;

  PathSpaceMetropolis() {
    const auto add = [&](const char* name, float share) {
      mutations.push_back(ref_cast<Mutation>(Registry::instance().create(name)));
      mutations.back()->share = share;
    };
    add("BidirectionalMutation", 1);
    add("LensMutation", 1);
    add("CausticMutation", 0.3f);
    add("MultiChainMutation", 0.5f);
  }

  static void describe(Description<PathSpaceMetropolis>& d) {
    d.summary("Metropolis light transport that mutates paths themselves.",
              "Veach & Guibas 1997, Metropolis light transport; Veach 1997, chapter 11");
    d.without("map_filter", "its chains know places on surfaces, and not how wide a pixel is there");
    d.group("Paths");
    describe_max_depth<&PathSpaceMetropolis::max_depth>(d, stored_subpath_depth, range(1, longest_stored_subpath));
    d.member<&PathSpaceMetropolis::mutations>("mutations", "", "ways in which paths are changed");
    describe_chain_starts<&PathSpaceMetropolis::mutations_per_sample, &PathSpaceMetropolis::chains,
                          &PathSpaceMetropolis::bootstrap, &PathSpaceMetropolis::large_steps,
                          &PathSpaceMetropolis::even_errors>(d);
  }

  bool splats() const override { return true; }
  PathClasses finds() const override {
    return seen_luminaires | specular_views | area_light | diffuse_light | glossy_light | area_caustics;
  }
  Estimator estimator() const override { return Estimator::correlated; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

namespace {

constexpr int direct_length = MutatedPaths::direct_length;

class PathSpaceProcess final : public RenderProcess, Chains {
 public:
  PathSpaceProcess(const PathSpaceMetropolis& r, const RenderContext& c, Ref<Renderer> direct)
      : RenderProcess(r, c),
        settings_(r),
        direct_renderer_(std::move(direct)),
        direct_(direct_renderer_->start(c)),
        groups_(c.scene, c.image) {
    require_mutable(c.wavelengths, r);
    if (!c.image.crop.empty()) r.fail({}, "renders whole pictures, no crops");
    if (c.camera.parallel()) r.fail({}, "needs a camera that sees from a place, and not by parallel rays");
    if (c.camera.shutter_close > c.camera.shutter_open)
      r.fail({}, "cannot mutate time: needs a camera whose shutter opens for a moment");
    if (r.mutations.empty()) r.fail("mutations", "there must be some");
    double sum = 0;
    for (const Ref<Mutation>& m : r.mutations) shares_.push_back(sum += double(m->share));
    sum = 0;
    for (int k = direct_length + 1; k <= r.max_depth; ++k) lengths_.push_back(sum += 1.0 / k);
  }

  void step(Schedule& schedule, const Step& step) override {
    RenderProcess::step(schedule, step);  // direct light
    if (lengths_.empty()) return;
    const auto pixels = std::uint64_t(context.image.width) * std::uint64_t(context.image.height);
    run_chains(schedule, context.image,
               {settings_.mutations_per_sample, settings_.chains, settings_.bootstrap, settings_.large_steps, 0,
                settings_.even_errors},
               *this, mix_bits(context.seed + mix_bits(step.samples.begin)), pixels * (step.samples.end - step.samples.begin),
               false);
  }
  Spectrum radiance(const Ray& ray, SampleContext& sample) const override { return direct_->radiance(ray, sample); }
  CameraSample sample(int, int, std::uint32_t, Arena&, const PathSink&) const override {
    renderer.fail({}, "its samples are mutations of one another: none belongs to a pixel, and none can be replayed by itself");
  }

 private:
  const PathSpaceMetropolis& settings_;
  const Ref<Renderer> direct_renderer_;
  const std::unique_ptr<RenderProcess> direct_;
  const LightGroups groups_;
  std::vector<double> shares_, lengths_;  ///< cumulative sums: of the mutations' shares, of 1 / k

  /// Samples an index in proportion to the terms of cumulative sums.
  static size_t chosen(const std::vector<double>& sums, double u) {
    return std::min(size_t(std::ranges::upper_bound(sums, u * sums.back()) - sums.begin()), sums.size() - 1);
  }
  /// P(k)
  double length_share(int k) const { return 1.0 / k / lengths_.back(); }
  /// T(y), the pdf of an independent path.
  double pdf(const LightPath& y) const { return length_share(y.length()) * PathSpace::pdf(y, 0, y.length()); }
  /// F = f / T; empty if no path was found.
  void contribution(const LightPath& y, bool found, Contribution& F) const {
    F.clear();
    if (!found) return;
    // Where vertices lie near one another both f and T are far out of the range of floats, but their quotient is not.
    const double of_f = y.scale / pdf(y);
    const Spectrum light = map(y.f, [of_f](float f) { return float(double(f) * of_f); });
    const PixelArea film{0, 0, context.image.width, context.image.height};
    if (!groups_.any()) return F.add({y.film, light, y.seen, y.length()}, film);
    const LightParts parts(context.image, groups_);
    const SceneObject* const luminaire = y.x[0].point.object;
    LightParts::each_label(y.length(), luminaire, light, matches(y), [&](const SplatLabel& label, const Spectrum& part) {
      F.add({y.film, part, y.seen, LightParts::packed(label)}, film);
    });
  }
  /// The light path expressions that a path matches.
  static PathState matches(const LightPath& y) {
    PathStates* const states = PathStates::current();
    if (!states) return {};
    PathState path = path_after_camera;
    for (size_t i = size_t(y.length()) - 1; i > 0; --i) {
      const ChainVertex& v = y.x[i];
      path = states->scattered(path, v, -y.x[i - 1].out, v.leaves_specularly ? v.lobe : diffuse_reflection);
    }
    return states->ended(path, y.x[0].point.object);
  }
  static double luminance(const Contribution& F) {
    double sum = 0;
    for (const Contribution::Brightness& part : F.luminances) sum += double(part.luminance);
    return sum;
  }
  /// Begins a path without vertices, with new wavelengths and a new lens sample.
  void begin_anew(const PathSpace& space, Arena& arena, ChoiceNumbers& choices, LightPath& y) const {
    LightPath none;
    none.wavelengths = wavelengths({}, std::min(float(choices.next()), one_minus_epsilon));
    none.lens = {float(choices.next()), float(choices.next())};
    none.arena = &arena;
    space.begin(y, none, 0);
  }
  bool independent(const PathSpace& space, Arena& arena, ChoiceNumbers& choices, LightPath& y) const {
    begin_anew(space, arena, choices, y);
    const int k = direct_length + 1 + int(chosen(lengths_, choices.next()));
    return space.join(y, {space.lens(y)}, k, choices);
  }

  /// Samples the path y that represents all paths of a pair of subpaths, and its F. Returns the sum of their brightness; 0:
  /// none.
  double begun(const PathSpace& space, Arena& arena, ChoiceNumbers& choices, LightPath& y, Contribution& F) const {
    LightPath each;
    begin_anew(space, arena, choices, each);
    double sum = 0;
    Contribution own;
    F.clear();
    space.all_ways(each, direct_length + 1, settings_.max_depth, choices, [&](const LightPath& path, double likely) {
      contribution(path, true, own);
      if (own.parts.empty()) return;
      const double light = luminance(own) * length_share(path.length()) / likely;
      sum += light;
      if (choices.next() * sum < light) {
        y = path;
        std::swap(F, own);
      }
    });
    return sum;
  }
  void draw(std::uint64_t seed, Arena& arena, const std::atomic<bool>*, Contribution& F) const override {
    const PathSpace space(context, *settings_.light_sampler);
    static thread_local LightPath y;
    ChoiceNumbers choices(seed);
    const ArenaScope memory(arena);
    const double all = begun(space, arena, choices, y, F);
    const double own = luminance(F);
    for (Contribution::Brightness& part : F.luminances)
      part.luminance = own > 0 ? float(all * (double(part.luminance) / own)) : 0;
  }

  void run(std::uint64_t first, std::uint64_t own_seed, std::uint64_t states, const StateWeights& weights, const FilmWeights& v,
           ImageTile& tile, Arena&, const std::atomic<bool>* abort) const override {
    Arena arenas[2];
    Arena* arena = &arenas[0];
    std::uint64_t accepted = 0;
    const PathSpace space(context, *settings_.light_sampler);
    auto x = std::make_unique<LightPath>(), y = std::make_unique<LightPath>();
    Contribution current, proposed;  // F
    ChoiceNumbers start(first), choices(own_seed);
    begun(space, *arena, start, *x, current);
    double I = current.brightness(v), waiting = 0;  // the weight of x that is not added to the film yet
    for (std::uint64_t i = 0; i < states && !(abort && abort->load(std::memory_order_relaxed)); ++i) {
      const Arena::Mark before = arena->mark();
      const bool large = choices.next() < double(settings_.large_steps);
      double ratio = 0;  // T(y -> x) / T(x -> y), times T(y) / T(x), as I is that of F
      bool found = false;
      if (large) {
        found = independent(space, *arena, choices, *y);
        ratio = 1;
      } else if (I > 0) {
        const Mutation& mutation = *settings_.mutations[chosen(shares_, choices.next())];
        const std::optional<double> back = mutation.propose(space, *x, *y, choices);
        found = back && *back > 0 && y->length() > direct_length && y->length() <= settings_.max_depth;
        if (found) ratio = *back * pdf(*y) / pdf(*x);
      }
      contribution(*y, found, proposed);
      proposed.report_bad(tile);
      const double J = proposed.brightness(v), accept = !(I > 0) ? 1 : std::min(1.0, J * ratio / I);
      waiting += weights.factor(false, 1 - accept, I);
      const double now = weights.factor(large, accept, J);
      if (choices.next() < accept) {
        current.add_to(tile, waiting);
        std::swap(current, proposed);
        std::swap(x, y);
        I = J;
        waiting = now;
        if (!(I > 0)) {
          arena->rewind(before);
        } else if (++accepted % 256 == 0) {  // frees the memory of vertices that are no longer used
          arena = &arenas[arena == &arenas[0]];
          arena->reset();
          space.move(*x, *arena);
        }
      } else {
        arena->rewind(before);
        proposed.add_to(tile, now);
      }
    }
    current.add_to(tile, waiting);
  }
};

}  // namespace

std::unique_ptr<RenderProcess> PathSpaceMetropolis::begin(const RenderContext& context) const {
  const auto direct = ref_cast<Renderer>(Registry::instance().create("BidirectionalPathTracer"));
  direct->sampler = sampler;
  direct->light_sampler = light_sampler;
  set(*direct, "max_depth", Value(Number{double(std::min(max_depth, direct_length))}));
  return std::make_unique<PathSpaceProcess>(*this, context, direct);
}

static const Register<PathSpaceMetropolis> registered;

}  // namespace etendue
