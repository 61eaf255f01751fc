// Path guiding: path tracing that learns where light comes from.
//
// As in path tracing, radiance along a ray is the sum over the vertices x_k of a random walk
//     L = sum_k T_k [ L_e(x_k) + direct(x_k) ],   T_{k+1} = T_k f |cos| / p,
// with luminaires found in two ways that are weighted against each other (path_tracer.cpp). A walk goes on in directions of the
// density
//     p(w) = a p_guide(w) + (1 - a) p_scatter(w)                    (one-sample mixture: Veach 1997, section 9.2.4)
// at surfaces and in media alike; specular lobes are chosen by scattering alone, with probability 1 - a. What guides is a
// density for each place that follows what paths have found there (guiding/guide.h): Müller, Gross & Novák 2017, "Practical
// path guiding for efficient light-transport simulation"; a is learned and the sums are smoothed as in Müller 2019, "Path
// guiding in production". What is followed is the mean of f |cos| L_i over all paths, or the root of its second moment (Rath et
// al. 2020, "Variance-aware path guiding").
//
// For each vertex a path notes the light that came back by way of the direction it chose, over its throughput there:
//     X_k = mean over wavelengths of (L - what came otherwise) / T_k,
// the mean over a path's wavelengths, which are drawn as the eye is sensitive. Samples of a step see the guide of the steps
// before: each is unbiased, so all count in the picture alike. Rounds of learning double, as fewer samples teach little: the
// guide changes after 1, 2, 4, 8, ... steps.
//
// Russian roulette ends a walk by what would be left of it had scattering alone chosen the same directions: T itself is small
// just where a guide leads into light.

#include "etendue/guiding/guide.h"
#include "etendue/render/renderer.h"
#include "etendue/render/shown_in_space.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/roulette.h"

namespace etendue {

class GuidedPathTracer final : public Renderer {
 public:
  int max_depth = 64;
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
  bool next_event = true;
  GuideTarget target = GuideTarget::mean;
  bool learn_share = true;
  float share = 0.5f;
  float region_samples = 24;
  int memory = 512;

  static void describe(Description<GuidedPathTracer>& d) {
    d.summary("Path tracing that learns, from its own paths, in which directions light is found from each place.",
              "Müller, Gross & Novák 2017; Müller 2019; Rath et al. 2020");
    d.group("Paths");
    describe_max_depth<&GuidedPathTracer::max_depth>(d);
    describe_roulette_depth<&GuidedPathTracer::roulette_depth>(d);
    describe_heuristic<&GuidedPathTracer::heuristic>(d, when("next_event"));
    d.member<&GuidedPathTracer::next_event>("next_event", "",
                                            "whether luminaires are sampled; without, paths must meet them by chance");
    d.group("Guide")
        .member<&GuidedPathTracer::target>("target", "", "what directions are chosen in proportion to, of the light they bring",
                                           choices("second_moment", "mean"))
        .member<&GuidedPathTracer::learn_share>(
            "learn_share", "", "whether each region learns how often its guide chooses the direction, rather than the surface")
        .member<&GuidedPathTracer::share>(
            "share", "1", "how often the guide chooses: at first, or always if that is not learned", range(0.05, 0.95))
        .member<&GuidedPathTracer::region_samples>(
            "region_samples", "1",
            "effective samples with which a region of space is divided, in the first round of learning; more in later ones",
            range(8, 1e9), logarithmic)
        .member<&GuidedPathTracer::memory>("memory", "1",
                                           "most that the guide, and what it learns from, take, in MiB; states that are saved "
                                           "are as large as the guide",
                                           range(4, 1 << 20), logarithmic);
  }

  // Smaller ones than usual: the sooner it begins to learn the better.
  std::uint32_t samples_per_step(std::uint32_t usual) const override { return std::max(usual / 8, 1u); }
  bool steps_depend() const override { return true; }
  PathClasses finds() const override {
    const PathClasses lost = delta_caustics | delta_caustics_in_mirrors;
    return all_paths & ~(next_event ? lost : lost | delta_light);
  }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

namespace {

/// The side of a surface where a path came from; zero in media.
Normal3 facing(const Vertex& v) {
  if (!v.on_surface()) return {};
  return dot(v.point.normal, v.out) < 0 ? -v.point.normal : v.point.normal;
}

/// What a path found from the vertices it left, as far as a guide learns from them.
class Trail {
 public:
  static constexpr int longest = 16;  ///< vertices deeper in a path are left out

  void left(const GuideSample& sample, const Spectrum& throughput) {
    waits_ = length_ < longest;
    if (waits_) left_[length_++] = {sample, throughput, {}};
  }
  /// The light of a path that has not come along its last segment.
  void arrived(const Spectrum& earlier) {
    if (waits_) left_[length_ - 1].earlier = earlier;
    waits_ = false;
  }
  /// Tells what was found, given all light of the path.
  void record(const Spectrum& all, SampleContext& sample) {
    for (int i = 0; i < length_; ++i) {
      left_[i].sample.found = left_[i].found(all);
      sample.record(left_[i].sample);
    }
  }

 private:
  struct Left {
    GuideSample sample;
    Spectrum throughput, earlier;

    /// X: the mean over those wavelengths that were still carried.
    float found(const Spectrum& all) const {
      float sum = 0;
      int carried = 0;
      for (int i = 0; i < spectrum_size; ++i)
        if (throughput[i] > 0) {
          sum += std::max(all[i] - earlier[i], 0.0f) / throughput[i];
          ++carried;
        }
      return carried > 0 ? sum / float(carried) : 0;
    }
  };

  Left left_[longest];
  int length_ = 0;
  bool waits_ = false;
};

/// How a walk goes on from a vertex: p(w) = a p_guide(w) + (1 - a) p_scatter(w).
class Mixture {
 public:
  Mixture(const Guide& guide, const Vertex& v) : vertex_(v) {
    if (!v.scatters_smoothly()) return;
    normal_ = facing(v);
    region_ = &guide.at(v.point.position, normal_);
    share_ = region_->share();
  }

  /// f |cos| and p, as direct light is weighted.
  ScatterValue operator()(const Vector3& in) const {
    ScatterValue f = scattering(vertex_, vertex_.out, in, Transport::radiance);
    if (share_ > 0 && !f.value.black()) f.density = mixed(region_->directions().density(in), f.density);
    return f;
  }

  /// A direction, and what a guide is told of how it was chosen.
  template <class Walk>
  std::optional<ScatterSample> sample(const Walk& walk, const NumberStream::Bounce& u, GuideSample& note) const {
    note = {vertex_.point.position, normal_, {}, 0, 0, share_ > 0 ? 0.0f : -1.0f, 0, false};
    std::optional<ScatterSample> s;
    if (u.lobe_choice < share_) {
      const Vector3 in = region_->directions().sample(u.direction, note.guide);
      note.scatter = scattering_density(vertex_, vertex_.out, in, Transport::radiance);
      s = scattered_towards(vertex_, in, mixed(note.guide, note.scatter), Transport::radiance);
      if (s && alone(*s)) s.reset();
    } else {
      s = walk.sample_direction(std::min((u.lobe_choice - share_) / (1 - share_), one_minus_epsilon), u.direction);
      if (s) note.scatter = s->density;
      if (s && alone(*s)) {
        note.specular = true;
        s->weight /= 1 - share_;
      } else if (s && share_ > 0) {
        note.guide = region_->directions().density(s->direction);
        s->density = mixed(note.guide, note.scatter);
        s->weight *= note.scatter / s->density;
      }
    }
    if (s) {
      note.direction = s->direction;
      note.density = note.specular ? (1 - share_) * note.scatter : s->density;
    }
    return s;
  }

 private:
  float mixed(float guide, float scatter) const { return share_ * guide + (1 - share_) * scatter; }
  /// Whether only scattering chooses such directions: those of mirrors, and into bodies that light leaves elsewhere.
  bool alone(const ScatterSample& s) const {
    return s.specular() || (vertex_.on_surface() && !vertex_.moved && enters_body(vertex_.point, s));
  }

  const Vertex& vertex_;
  Normal3 normal_{};  // where the path came from; zero in media
  const Guide::Region* region_ = nullptr;
  float share_ = 0;  // a
};

class GuidedProcess final : public RenderProcess, public ShownInSpace {
 public:
  GuidedProcess(const GuidedPathTracer& r, const RenderContext& c)
      : RenderProcess(r, c),
        settings_(r),
        clear_(!c.scene.has_interiors() && !c.scene.has_null_surfaces()),
        guide_(c.scene.centre(), c.scene.radius(), guide_settings(r)) {}

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    return clear_ ? follow(CameraWalk<true>(context.scene, sample, ray, settings_.max_depth))
                  : follow(CameraWalk<false>(context.scene, sample, ray, settings_.max_depth));
  }

  void step(Schedule& schedule, const Step& step) override {
    const PixelArea area = context.image.sampled_area();
    const double paths = double(area.width()) * double(area.height()) * double(step.samples.end - step.samples.begin);
    noting_ = std::uint64_t(std::min(room() / Trail::longest / std::max(paths, 1.0), 1.0) * 0x1p32);
    const std::vector<GuideSample> samples = film_paths<GuideSample>(schedule, step);
    learn(schedule, samples, settings_.target);
    const std::uint64_t steps = step.number + std::uint64_t(1);
    if ((steps & (steps - 1)) == 0 && !schedule.aborted()) guide_.refine(settings_.target);
  }

  std::optional<ShownLobes> lobes(const Point3& position, const Normal3& normal) const override {
    const Guide::Region& region = guide_.at(position, normal);
    ShownLobes shown{{}, region.share()};
    for (int row = 0; row < ShownLobes::rows; ++row)
      for (int column = 0; column < ShownLobes::columns; ++column)
        shown.density.push_back(region.directions().density(ShownLobes::direction(row, column)));
    return shown;
  }

  std::vector<std::byte> save_state() const override { return guide_.save(); }
  void load_state(std::span<const std::byte> bytes) override { guide_.load(bytes); }

 private:
  static GuideSettings guide_settings(const GuidedPathTracer& r) {
    GuideSettings s;
    s.region_samples = r.region_samples;
    s.share = r.share;
    if (!r.learn_share) s.learning_rate = 0;
    s.memory = (size_t(r.memory) << 20) / 8;  // besides it there are states of it, being made and kept
    return s;
  }

  template <class Walk>
  [[gnu::always_inline]] Spectrum follow(Walk&& walk) const {
    Trail trail;
    const SampleKey key = walk.numbers.key();
    const bool noting = walk.sample.records && (mix_bits(key.walk + key.sample) >> 32) < noting_;
    const LightSampler& lights = *settings_.light_sampler;
    const Roulette roulette{settings_.roulette_depth};
    float more = 1;  // the product of p / p_scatter: by so much more would be left without a guide
    const auto met = [&](const SurfacePoint& luminaire) {
      return settings_.next_event ? walk.weight_of_met(lights, settings_.heuristic, luminaire) : 1.0f;
    };
    const auto next_vertex = [&] {
      const bool goes_on = walk.next_vertex(met);
      trail.arrived(walk.earlier);
      return goes_on;
    };
    while (next_vertex() && !walk.at_end()) {
      const NumberStream::Bounce u = walk.numbers.next_bounce();
      const Mixture mixture(guide_, walk.vertex);
      if (settings_.next_event) walk.add_direct(lights, u, settings_.heuristic, mixture);
      GuideSample note;
      const std::optional<ScatterSample> next = mixture.sample(walk, u, note);
      if (!next) continue;
      if (noting) trail.left(note, walk.throughput);
      if (note.scatter > 0) more *= note.density / note.scatter;
      if (walk.go_on(*next) && !roulette.survives(walk, walk.left() * more)) walk.end();
    }
    trail.record(walk.radiance, walk.sample);
    return walk.radiance;
  }

  /// How many samples there may be in half of the memory, copies made on the way included.
  double room() const { return double(size_t(settings_.memory) << 20) / 2 / (5 * sizeof(GuideSample)); }

  /// Samples go to their regions, which then learn at once, each from its own in their order.
  void learn(Schedule& schedule, const std::vector<GuideSample>& samples, GuideTarget target) {
    constexpr size_t part = 8192;
    const std::vector<std::uint32_t> region =
        schedule.collect<std::uint32_t>((samples.size() + part - 1) / part, [&](std::uint64_t item, auto& regions, Arena&) {
          for (size_t i = size_t(item) * part; i < std::min(samples.size(), (size_t(item) + 1) * part); ++i)
            regions.push_back(guide_.region_for(samples[i]));
        });
    if (schedule.aborted()) return;
    std::vector<size_t> end(guide_.regions() + 1, 0);
    for (const std::uint32_t r : region) ++end[r + 1];
    for (size_t r = 1; r < end.size(); ++r) end[r] += end[r - 1];
    std::vector<const GuideSample*> sorted(samples.size());
    for (size_t i = 0; i < samples.size(); ++i) sorted[end[region[i]]++] = &samples[i];
    // Now `end` is of each region where its samples end, and those of the next begin.
    schedule.collect<char>(guide_.regions(), [&](std::uint64_t item, auto&, Arena&) {
      const auto r = std::uint32_t(item);
      const size_t begin = r > 0 ? end[r - 1] : 0;
      guide_.learn(r, std::span(sorted).subspan(begin, end[r] - begin), target);
    });
  }

  const GuidedPathTracer& settings_;
  const bool clear_;
  Guide guide_;
  std::uint64_t noting_ = 0;  // of 2^32 paths so many are learned from
};

}  // namespace

std::unique_ptr<RenderProcess> GuidedPathTracer::begin(const RenderContext& context) const {
  return std::make_unique<GuidedProcess>(*this, context);
}

static const Register<GuidedPathTracer> registered;

}  // namespace etendue
